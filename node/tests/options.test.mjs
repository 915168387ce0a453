// SPDX-License-Identifier: Apache-2.0
// The options of the command as options of the package: each row of the table, with the bytes of the command.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { copyOptionFiles, optionRows } from '../../web/test/options.mjs';
import { install, program } from './install.mjs';

const folder = install(), home = process.cwd(), refused = ['threads', 'isa', 'sandbox'];
let zoneplate, optionName;
before(async () => {
  const load = (name) => import(pathToFileURL(path.join(folder, 'node_modules/zoneplate', name)).href);
  process.chdir(folder);
  copyOptionFiles(folder);
  zoneplate = await load('index.js');
  ({ optionName } = await load('requests.js'));
});
after(() => {
  process.chdir(home);
  zoneplate.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

/// The files of the command.
function native(model, output, options) {
  fs.rmSync('out', { recursive: true, force: true });
  fs.mkdirSync('out');
  execFileSync(program, ['render', model, '-o', `out/${output}`, '--quiet', ...options.map(([name, value]) => (value === '' ? `--${name}` : `--${name}=${value}`))]);
  return Object.fromEntries(fs.readdirSync('out').map((name) => [name, fs.readFileSync(path.join('out', name))]));
}

const optionsOf = (pairs) => Object.fromEntries(pairs.map(([name, value]) => [optionName(name), value === '' ? true : value]));

test('each row gives the files of the command, or is refused by name', async () => {
  const rows = optionRows(), listed = (await zoneplate.list()).options.map(({ name }) => name);
  assert.deepEqual([...listed, ...refused].sort(), rows.map(({ name }) => name).sort());
  for (const { name, model, output, options } of rows) {
    const made = zoneplate.renderFiles(model, output, optionsOf(options));
    if (refused.includes(name)) {
      await assert.rejects(made, ({ code, message }) => code === 'usage' && message.startsWith(`${name}: is an option of the program`), name);
      continue;
    }
    const { files } = await made, expected = native(model, output, options);
    assert.deepEqual(Object.keys(files).sort(), Object.keys(expected).sort(), name);
    for (const [file, bytes] of Object.entries(expected)) assert.ok(bytes.equals(files[file]), `${name}: ${file}`);
  }
});

test('a row acts on an image in memory, and an error names it', async () => {
  const size = [48, 40], render = (options) => zoneplate.render('teapot', { size, ...options });
  const { data } = await render({ edges: 'mesh', hdriFile: 'sky.hdr', exposure: 'auto', section: ['1,0,0,0', [0, 0, 1, -0.2]], shadows: 'soft:samples=8' });
  const expected = native('teapot', 'a.png', [['resolution', '48,40'], ['edges', 'mesh'], ['hdri-file', 'sky.hdr'], ['exposure', 'auto'], ['section', '1,0,0,0'], ['section', '0,0,1,-0.2'], ['shadows', 'soft:samples=8']]);
  assert.ok(expected['a.png'].equals(data));
  const refuses = (options, text) => assert.rejects(render(options), ({ code, message }) => code === 'usage' && text.test(message), String(text));
  await refuses({ shadow: 'hard' }, /^shadow: there is no such option; did you mean shadows\?$/);
  await refuses({ shadows: 'hrad' }, /^shadows: /);
  await refuses({ turntable: 3 }, /sequence of frames/);
  await refuses({ jpegQuality: 50 }, /^jpeg-quality is for \.jpg/);
  await refuses({ maxMemory: '3G' }, /^max-memory: is 3G, expected at most 2 GiB$/);
  await refuses({ view: { azimut: 3 } }, /view: no option 'azimut'; there are/);
  await assert.rejects(zoneplate.info('teapot', { shadows: 'hard' }), /^ZoneplateError: shadows: is an option of render, not of info$/);
});
