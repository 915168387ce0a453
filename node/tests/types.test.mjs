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
const text = fs.readFileSync(path.join(folder, 'node_modules/zoneplate/index.d.ts'), 'utf8');

/// The members of an interface.
const membersOf = (name) => {
  const [, body] = new RegExp(`export interface ${name}[^{]*\\{(.*?)\n\\}`, 's').exec(text);
  return [...body.matchAll(/^ {2}(?:readonly )?(\w+)\??:/gm)].map(([, member]) => member);
};

test('every option has a type', async () => {
  const { render, close } = await import(path.join(folder, 'node_modules/zoneplate/index.js'));
  const known = async (options) => {
    const { message } = await render('teapot', options).then(() => assert.fail(), (error) => error);
    return /there are (.*)$/.exec(message)[1].split(', ').sort();
  };
  assert.deepEqual(await known({ unknown: 1 }), membersOf('RenderOptions').filter((name) => name !== 'view' && name !== 'camera').sort());
  assert.deepEqual(await known({ view: { unknown: 1 } }), membersOf('View').sort());
  assert.deepEqual(await known({ camera: { unknown: 1 } }), membersOf('Camera').sort());
  close();
});

const tsc = ['tsc', '/usr/lib/node_modules/typescript/bin/tsc'].find((name) => spawnSync(name, ['--version']).status === 0);
test('TypeScript accepts right calls and no wrong ones', { skip: tsc ? false : 'no tsc here' }, () => {
  fs.writeFileSync(path.join(folder, 'example.mts'), `import { compare, info, render } from 'zoneplate';
import { toMatchRender } from 'zoneplate/matcher';
const image = await render('chair.glb', { size: [640, 480], aa: 'smaa', view: { azimuth: 20 }, aovs: ['depth'] });
const bytes: Uint8Array = image.data, depth = image.arrays.depth.data;
const { metrics } = await compare('a.png', image, { metrics: ['flip'], ignore: [[0, 0, 8, 8]] });
const value: number = metrics.flip.value, count: number = (await info('chair.glb')).triangles;
// @ts-expect-error
render('chair.glb', { antialias: 'smaa' });
// @ts-expect-error
render('chair.glb', { size: 640 });
export { bytes, count, depth, toMatchRender, value };
`);
  fs.writeFileSync(path.join(folder, 'required.cts'), `import zoneplate = require('zoneplate');
import matcher = require('zoneplate/matcher');
export const rendered: Promise<zoneplate.RenderedImage> = zoneplate.render('teapot'), match = matcher.toMatchRender;
`);
  const { status, stdout } = spawnSync(tsc, ['--strict', '--noEmit', '--target', 'es2022', '--module', 'nodenext', '--moduleResolution', 'nodenext', '--skipLibCheck', 'false', '--lib', 'es2022,dom', 'example.mts', 'required.cts'], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stdout);
});
