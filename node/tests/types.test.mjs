// SPDX-License-Identifier: Apache-2.0
// The types: the members of index.d.ts are those that the module reads, and TypeScript accepts an example if it is there.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { after, test } from 'node:test';
import { install } from './install.mjs';

const folder = install();
after(() => fs.rmSync(folder, { recursive: true, force: true }));
const typesOf = (name) => fs.readFileSync(path.join(folder, 'node_modules/zoneplate', name), 'utf8');

/// The members of an interface.
const membersOf = (name, text) => {
  const [, body] = new RegExp(`export interface ${name}[^{]*\\{(.*?)\n\\}`, 's').exec(text);
  return [...body.matchAll(/^ {2}(?:readonly )?(\w+)\??:/gm)].map(([, member]) => member);
};

test('every row of the table of options has a type, and every type is read', async () => {
  const { list, render, close } = await import(path.join(folder, 'node_modules/zoneplate/index.js'));
  const { optionName } = await import(path.join(folder, 'node_modules/zoneplate/requests.js'));
  const names = (await list()).options.map(({ name }) => optionName(name)), generated = typesOf('options.d.ts'), own = typesOf('index.d.ts');
  const rows = ['ReadingOptions', 'ImageOptions', 'FileOptions'].flatMap((name) => membersOf(name, generated));
  assert.equal(new Set(rows).size, rows.length);
  assert.deepEqual(rows.filter((name) => !names.includes(name)), []);
  // The rest is in index.d.ts, shorter or typed otherwise.
  const shorter = { resolution: 'size', antiAliasing: 'aa', aov: 'aovs', backgroundColor: 'background', noBackground: 'transparent', noCull: 'cullBackFaces' };
  const common = [...membersOf('CommonOptions', own), ...membersOf('LoadOptions', own)];
  for (const name of names) if (!rows.includes(name)) assert.ok(common.includes(shorter[name] ?? name), name);
  const known = async (options) => /there are (.*)$/.exec((await render('teapot', options).then(() => assert.fail(), (error) => error)).message)[1].split(', ').sort();
  assert.deepEqual(await known({ view: { unknown: 1 } }), membersOf('View', own).sort());
  assert.deepEqual(await known({ camera: { matrix: Array(16).fill(0), unknown: 1 } }), membersOf('Camera', own).sort());
  close();
});

const tsc = ['tsc', '/usr/lib/node_modules/typescript/bin/tsc'].find((name) => spawnSync(name, ['--version']).status === 0);
test('TypeScript accepts right calls and no wrong ones', { skip: tsc ? false : 'no tsc here' }, () => {
  fs.writeFileSync(path.join(folder, 'example.mts'), `import { compare, info, render, renderFiles } from 'zoneplate';
import { toMatchRender } from 'zoneplate/matcher';
const image = await render('chair.glb', { size: [640, 480], aa: 'smaa', view: { azimuth: 20 }, aovs: ['depth'] });
const bytes: Uint8Array = image.data, depth = image.arrays.depth.data;
const { metrics } = await compare('a.png', image, { metrics: ['flip'], ignore: [[0, 0, 8, 8]] });
const value: number = metrics.flip.value, count: number = (await info('chair.glb')).triangles;
const { files } = await renderFiles('chair.glb', 'a.##.png', { turntable: 3, quality: 'best', section: [1, 0, 0, 0], shadows: 'soft:samples=8', jpegQuality: 9 });
const first: Uint8Array = files['a.00.png'];
// @ts-expect-error
render('chair.glb', { turntable: 3 });
// @ts-expect-error
render('chair.glb', { antialias: 'smaa' });
// @ts-expect-error
render('chair.glb', { size: 640 });
export { bytes, count, depth, first, toMatchRender, value };
`);
  fs.writeFileSync(path.join(folder, 'required.cts'), `import zoneplate = require('zoneplate');
import matcher = require('zoneplate/matcher');
export const rendered: Promise<zoneplate.RenderedImage> = zoneplate.render('teapot'), match = matcher.toMatchRender;
`);
  const { status, stdout } = spawnSync(tsc, ['--strict', '--noEmit', '--target', 'es2022', '--module', 'nodenext', '--moduleResolution', 'nodenext', '--skipLibCheck', 'false', '--lib', 'es2022,dom', 'example.mts', 'required.cts'], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stdout);
});
