// SPDX-License-Identifier: Apache-2.0
// The package in Chromium: the bytes of the native program.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Browser } from '../../web/test/browser.mjs';
import { writeModels } from '../../web/test/models.mjs';
import { serve } from '../../web/test/server.mjs';
import { install, program } from './install.mjs';

const folder = install(), at = (name) => path.join(folder, name);
let browser, server, page;
before(async () => {
  writeModels(folder);
  fs.writeFileSync(at('index.html'), '<!doctype html><meta charset="utf-8"><title>package</title><link rel="icon" href="data:,"><p>package</p>');
  browser = new Browser(), server = await serve(folder);
  page = await browser.page();
  await page.open(`${server.address}/index.html`);
});
after(async () => {
  assert.deepEqual(page.problems, []);
  await browser.close();
  await server.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

function native(model) {
  execFileSync(program, ['render', model, '-o', 'native.png', '--size', '96x64', '--quiet'], { cwd: folder });
  return fs.readFileSync(at('native.png')).toString('base64');
}

test('models by URL, built-in scenes, and models in memory', async () => {
  const found = await page.evaluate(async () => {
    const { render, setWorkers } = await import('./node_modules/zoneplate/browser.js');
    setWorkers(2);
    const base64 = ({ data }) => btoa(String.fromCharCode(...data)), size = [96, 64];
    const bytes = async (name) => new Uint8Array(await (await fetch(name)).arrayBuffer());
    const files = {};
    for (const name of ['square.gltf', 'square.bin', 'face.png']) files[name] = await bytes(name);
    const images = await Promise.all([render('square.glb', { size }), render('teapot', { size }), render('square.gltf', { size, files }), render(await bytes('square.glb'), { size })]);
    return images.map(base64);
  });
  const [glb, teapot, gltf] = ['square.glb', 'teapot', 'square.gltf'].map(native);
  assert.deepEqual(found, [glb, teapot, gltf, glb]);
});

test('info, compare and errors', async () => {
  const { triangles, psnr, message, code } = await page.evaluate(async () => {
    const { render, info, compare } = await import('./node_modules/zoneplate/browser.js');
    const image = await render('square.glb', { size: [96, 64], output: 'pixels' });
    const { metrics } = await compare(image, await render('square.glb', { size: [96, 64], aa: 'none' }), { metrics: ['psnr'] });
    const error = await render(new Uint8Array([1, 2, 3])).catch((caught) => caught);
    return { triangles: (await info('square.glb')).triangles, psnr: metrics.psnr.value, message: error.message, code: error.code };
  });
  assert.equal(triangles, 2);
  assert.ok(psnr > 15 && psnr < 60, String(psnr));
  assert.equal(code, 'input');
  assert.match(message, /^model: /);
});
