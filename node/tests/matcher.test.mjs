// SPDX-License-Identifier: Apache-2.0
// The matcher, with the part of `expect` that vitest, jest and Playwright have in common.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { waveGlb } from '../../web/test/models.mjs';
import { install, program } from './install.mjs';

const folder = install(), at = (name) => path.join(folder, name), home = process.cwd();
const size = [160, 120];
let toMatchRender, render;

/// What `expect(received).toMatchRender(...)` of a runner does.
const match = async (received, expected, options, context = { isNot: false }) => {
  const { pass, message } = await toMatchRender.call(context, received, expected, options);
  return { pass, text: message() };
};

before(async () => {
  process.chdir(folder);
  const entry = (name) => import(pathToFileURL(at(`node_modules/zoneplate/${name}`)).href);
  ({ toMatchRender } = await entry('matcher.js'));
  ({ render } = await entry('index.js'));
  fs.writeFileSync(at('wave.glb'), waveGlb(20));
  fs.writeFileSync(at('other.glb'), waveGlb(12));
  execFileSync(program, ['render', 'wave.glb', '-o', 'golden.png', '--size', '160x120', '--quiet'], { cwd: folder });
});
after(() => {
  process.chdir(home);
  fs.rmSync(folder, { recursive: true, force: true });
});

test('a model matches its image exactly, and another model does not', async () => {
  assert.deepEqual((await match('wave.glb', 'golden.png', { render: { size } })).pass, true);
  const { pass, text } = await match('other.glb', 'golden.png', { render: { size } });
  assert.equal(pass, false);
  assert.match(text, /^golden\.png: \d+ pixels differ by more than 0 codes; 0 may; the image is .*golden\.actual\.png$/);
  assert.ok(fs.readFileSync(at('golden.actual.png')).equals((await render('other.glb', { size })).data));
});

test('antialiasing does not count, where edges of the model do', async () => {
  const options = { render: { size, aa: 'none' }, tolerance: 4, pixels: 10 }; // a few at corners of the silhouette remain
  const all = await match('wave.glb', 'golden.png', options), edges = await match('wave.glb', 'golden.png', { ...options, antialiasing: true });
  assert.equal(all.pass, false);
  assert.equal(edges.pass, true, edges.text);
  assert.equal((await match('other.glb', 'golden.png', { ...options, antialiasing: true })).pass, false);
});

test('the tolerance in JND', async () => {
  const smaa = { render: { size, aa: 'smaa' } };
  assert.equal((await match('wave.glb', 'golden.png', { ...smaa, jnd: 0 })).pass, false);
  const { pass, text } = await match('wave.glb', 'golden.png', { ...smaa, jnd: 1 });
  assert.ok(pass, text);
  const teapot = await match('teapot', 'golden.png', { render: { size }, jnd: 1 });
  assert.equal(teapot.pass, false);
  assert.match(teapot.text, /the difference is [\d.]+ JND; 1 are allowed/);
});

test('images, of files, bytes and pixels', async () => {
  assert.ok((await match('golden.png', 'golden.png')).pass);
  assert.ok((await match(fs.readFileSync(at('golden.png')), 'golden.png')).pass);
  assert.ok((await match(await render('wave.glb', { size, output: 'pixels' }), await render('wave.glb', { size }))).pass);
  const { pass, text } = await match(await render('wave.glb', { size: [80, 60] }), 'golden.png');
  assert.equal(pass, false);
  assert.match(text, /80/);
});

test('a missing image fails, and is written when asked', async () => {
  const missing = await match('wave.glb', 'new/first.png', { render: { size } });
  assert.equal(missing.pass, false);
  assert.match(missing.text, /^new\/first\.png: no such image; ZONEPLATE_UPDATE=1, or --update, makes it$/);
  assert.equal((await match('wave.glb', 'new/first.png', { render: { size } }, { isNot: true })).pass, true, 'so that .not fails');
  assert.ok((await match('wave.glb', 'new/first.png', { render: { size } }, { isNot: false, snapshotState: { _updateSnapshot: 'all' } })).pass);
  assert.ok((await match('wave.glb', 'new/first.png', { render: { size } }, { isNot: false, snapshotState: { _updateSnapshot: 'none' } })).pass);
});

test('wrong options are errors, not results', async () => {
  await assert.rejects(match('wave.glb', 'golden.png', { jnd: 1, pixels: 3 }), /exclude/);
  await assert.rejects(match('wave.glb', 'golden.png', { tolerence: 3 }), /no option 'tolerence'/);
  await assert.rejects(match('wave.glb', 'golden.png', { render: { aa: 'smooth' } }), /smooth/);
});
