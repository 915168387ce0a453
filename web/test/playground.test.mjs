// The playground in Chromium: its images are those of the native program.
//
//   ZONEPLATE=build/check/zoneplate SITE=build/web/site node --test web/test/playground.test.mjs
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import zlib from 'node:zlib';
import { Browser } from './browser.mjs';
import { writeModels } from './models.mjs';
import { serve } from './server.mjs';

const program = path.resolve(process.env.ZONEPLATE ?? 'build/check/zoneplate');
const site = path.resolve(process.env.SITE ?? 'build/web/site');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-playground-'));
/// The bytes that the program writes for an image, four for each pixel.
function nativeImage(scene, method, size, ...options) {
  execFileSync(program, ['render', scene, '-o', 'image.rgba', '--size', size.join(), '--aa', method, '--quiet', ...options], { cwd: folder });
  return fs.readFileSync(path.join(folder, 'image.rgba'));
}

let browser, server;
const opened = [];
async function open(hash = '', options = {}) {
  const page = await browser.page(options);
  opened.push({ page, hash });
  await page.open(`${server.address}/playground/index.html${hash}`);
  await done(page);
  return page;
}
const done = async (page) => { await page.until('document.getElementById("app").dataset.done === "true"', 60); await page.settle(); };
/// The address, which follows within a third of a second.
const hashOf = async (page) => { await new Promise((wait) => setTimeout(wait, 400)); return page.evaluate('decodeURIComponent(location.hash)'); };

before(async () => { browser = new Browser(), server = await serve(site); });
after(async () => {
  for (const { page, hash } of opened) assert.deepEqual(page.problems, [], `problems of the page ${hash}`);
  await browser.close();
  await server.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

/// Asks a renderer of the page for images; returns their bytes in base64, and their times.
const renderAll = (page, jobs) => page.evaluate(async (list) => {
  const { Renderer } = await import('./renderer.js');
  const renderer = window.testRenderer ??= new Renderer();
  const out = [];
  for (const { scene, ...job } of list) {
    if (window.testScene !== scene) await renderer.ask('builtin', scene), window.testScene = scene;
    const { data, ms } = await renderer.ask('render', job);
    let text = '';
    for (let i = 0; i < data.length; i += 4096) text += String.fromCharCode(...data.subarray(i, i + 4096));
    out.push({ bytes: btoa(text), ms });
  }
  return out;
}, jobs);

test('ten scenes have the same bytes as those of the program, by every method', async () => {
  const page = await open(), [width, height] = [128, 72];
  const { methods } = await page.evaluate(async () => new (await import('./renderer.js')).Renderer().ask('catalogue'));
  assert.ok(methods.length > 20);
  const scenes = ['teapot', 'checkerboard', 'city', 'foliage', 'crossing', 'metal', 'wires', 'triangles', 'passing-fence', 'text-ui'];
  for (const scene of scenes) {
    const jobs = methods.map(({ name }) => ({ scene, width, height, method: name }));
    const images = await renderAll(page, jobs);
    jobs.forEach(({ method }, i) => assert.ok(Buffer.from(images[i].bytes, 'base64').equals(nativeImage(scene, method, [width, height])), `${scene} by ${method}`));
  }
});

test('a camera has the same bytes as that of the program', async () => {
  const page = await open(), job = { scene: 'teapot', width: 160, height: 90, method: 'msaa:n=4', azimuth: 75.5, elevation: -12.25, viewAngle: 18 };
  const [{ bytes }] = await renderAll(page, [job]);
  const options = ['--camera-azimuth-angle', '75.5', '--camera-elevation-angle', '-12.25', '--camera-view-angle', '18'];
  assert.ok(Buffer.from(bytes, 'base64').equals(nativeImage('teapot', job.method, [160, 90], ...options)));
});

test('frames of sequences have the same bytes as those that the stated command makes', async () => {
  const page = await open('#size=320x180'), size = { width: 128, height: 72 };
  const cases = [['passing-fence', 'taa', 5], ['passing-fence', 'msaa:n=4', 30], ['wires', 'taa', 2], ['teapot', 'smaa', 60], ['teleport', 'taa', 40]];
  for (const [scene, method, frame] of cases) {
    const [{ bytes }] = await renderAll(page, [{ scene, ...size, method, frame }]);
    const command = await page.evaluate(async (name, wanted, number) => {
      const { commandOf, readState } = await import('./state.js');
      const about = await window.testRenderer.ask('builtin', name);
      return commandOf({ ...readState(''), scene: name, size: '128x72', frame: String(number) }, about, { method: wanted, look: '', hasHistory: wanted === 'taa', output: 'image.rgba' });
    }, scene, method, frame);
    execFileSync(program, [...command.split(' ').slice(1), '--quiet'], { cwd: folder });
    assert.ok(Buffer.from(bytes, 'base64').equals(fs.readFileSync(path.join(folder, 'image.rgba'))), command);
  }
});

test('every option of rendering has the same bytes as that of the program', async () => {
  const page = await open('#size=320x180'), [width, height] = [128, 72];
  const cases = [['cyclic', 'visibility=painter'], ['crossing', 'edge-rule=inside'], ['teapot', 'shading-frequency=flat'], ['teapot', 'shading-frequency=gouraud'],
    ...['nearest', 'trilinear', 'ewa', 'probes', 'sat', 'catmull-rom'].map((filter) => ['tiles', `texture-filter=${filter}`]), ['checkerboard', 'anisotropy=8'],
    ...['geometric', 'full'].map((kind) => ['metal', `specular-aa=${kind}`]), ...['map', 'hard', 'soft'].map((kind) => ['teapot', `shadows=${kind},ground=shadow`]),
    ['teapot', 'ambient-occlusion=rays'], ...['aces', 'neutral', 'agx', 'filmic'].map((curve) => ['sun-roof', `tone-mapping=${curve},exposure=-1.5`])];
  const images = await renderAll(page, cases.map(([scene, look]) => ({ scene, width, height, method: 'msaa:n=4', look: `look:${look}` })));
  cases.forEach(([scene, look], i) => {
    const options = look.split(',').flatMap((item) => [`--${item.split('=')[0]}`, item.split('=')[1]]);
    assert.ok(Buffer.from(images[i].bytes, 'base64').equals(nativeImage(scene, 'msaa:n=4', [width, height], ...options)), `${scene} ${look}`);
  });
});

test('every lesson opens at every step with its knobs, and a knob changes the image', async () => {
  const page = await open('#size=320x180');
  const all = await page.evaluate(async () => (await import('./lessons.js')).lessons);
  for (const { name, steps } of all)
    for (let step = 0; step < steps.length; ++step) {
      await page.evaluate(`document.getElementById('app').dataset.done = 'false', location.hash = '#lesson=${name}&step=${step + 1}&${new URLSearchParams({ ...steps[step].state, size: '320x180', pixel: '', view: '' })}'`);
      await done(page);
      assert.equal(await page.evaluate('document.querySelector(".error").textContent'), '', `${name} ${step + 1}`);
      assert.equal(await page.evaluate('document.querySelectorAll(".knobs .field").length'), steps[step].knobs.length, `${name} ${step + 1}`);
    }
  await page.evaluate(() => { const list = document.querySelector('[aria-label="Lesson"]'); document.getElementById('app').dataset.done = 'false', list.selectedIndex = 1; list.dispatchEvent(new Event('change')); });
  await done(page);
  const before = await page.shot();
  await page.evaluate(() => { const knob = document.getElementById('knob-b-n'); document.getElementById('app').dataset.done = 'false', knob.value = '2', knob.dispatchEvent(new Event('change')); });
  await done(page);
  assert.match(await hashOf(page), /b=msaa:n=2/);
  assert.notDeepEqual((await page.shot()).data, before.data);
});

test('models of every format have the same bytes as those of the program', async () => {
  const page = await open('#size=320x180');
  for (const names of writeModels(folder)) {
    const files = names.map((name) => ({ path: name, text: fs.readFileSync(path.join(folder, name)).toString('base64') }));
    const text = await page.evaluate(async (list) => {
      const { Renderer } = await import('./renderer.js'), renderer = new Renderer();
      await renderer.ask('model', list.map((file) => ({ path: file.path, bytes: Uint8Array.from(atob(file.text), (c) => c.charCodeAt(0)) })));
      const { data } = await renderer.ask('render', { width: 64, height: 48, method: 'ssaa:n=2' });
      renderer.worker.terminate();
      return btoa(String.fromCharCode(...data));
    }, files);
    assert.ok(Buffer.from(text, 'base64').equals(nativeImage(names[0], 'ssaa:n=2', [64, 48])), names[0]);
  }
});

test('files are opened from the disk, and one that is no model is refused', async () => {
  const page = await open('#size=320x180');
  const drop = (names) => page.evaluate(async (list) => {
    const transfer = new DataTransfer(), input = document.querySelector('input[type="file"]');
    for (const { name, text } of list) transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    document.getElementById('app').dataset.done = 'false';
    input.files = transfer.files, input.dispatchEvent(new Event('change'));
  }, names.map((name) => ({ name, text: fs.readFileSync(path.join(folder, name)).toString('base64') })));
  writeModels(folder);
  await drop(['face.png', 'square.mtl', 'square.obj']);
  await done(page);
  assert.match(await hashOf(page), /scene=square\.obj/);
  assert.match(await page.evaluate('document.querySelector(".card").textContent'), /2 triangles/);
  await drop(['face.png']);
  await page.until('!document.querySelector(".error").hidden');
});

test('a frame of the teapot takes at most 60 ms', async (t) => {
  const page = await open('#size=320x180');
  const times = (await renderAll(page, Array(20).fill({ scene: 'teapot', width: 640, height: 360, method: 'msaa:n=4' }))).map(({ ms }) => ms).sort((a, b) => a - b);
  t.diagnostic(`teapot, 640 × 360, msaa:n=4: ${times[0].toFixed(1)} ms, median ${times[10].toFixed(1)} ms`);
  assert.ok(times[0] <= 60, `${times[0]} ms`);
});

test('the program of the page has at most 1.5 MB after gzip', (t) => {
  const size = zlib.gzipSync(fs.readFileSync(path.join(site, 'playground/zoneplate_playground.wasm')), { level: 9 }).length;
  t.diagnostic(`${size} bytes`);
  assert.ok(size <= 1.5e6, `${size} bytes`);
});

test('the address restores what is displayed', async () => {
  const page = await open('#scene=wires&a=fxaa&b=ssaa:n=2&size=320x180&layout=grid&pixel=100,60');
  assert.deepEqual(await page.evaluate('[...document.querySelectorAll("figcaption .name")].map((n) => n.textContent)'), ['fxaa', 'ssaa:n=2']);
  await page.until('document.querySelector(".samples output").textContent.startsWith("Pixel 100, 60")', 60);
  assert.equal(await page.evaluate('document.querySelectorAll(".samples svg").length'), 2);
});

test('dragging turns the camera and the address follows', async () => {
  const page = await open('#size=320x180'), box = await page.box('.room canvas');
  const before = await page.shot(), middle = { x: box.x + box.width / 4, y: box.y + box.height / 2 };
  await page.drag(middle, { x: middle.x + 50, y: middle.y });
  await done(page);
  assert.match(await hashOf(page), /azimuth=10&elevation=20/);
  assert.notDeepEqual((await page.shot()).data, before.data);
});

test('the samples of a pixel are stepped through by keys, and their mean is the pixel', async () => {
  const page = await open('#size=320x180&b=msaa:n=4&pixel=150,60');
  await page.until('document.querySelectorAll(".samples figure").length === 2');
  const text = () => page.evaluate('document.querySelector(".samples output").textContent');
  assert.match(await text(), /sample 4 of 4/);
  const codes = await page.evaluate('[...document.querySelectorAll(".samples figure:last-child dd")].slice(-2).map((n) => n.textContent)');
  assert.equal(codes[0], codes[1]);
  await page.key('b');
  assert.match(await text(), /sample 3 of 4/);
  const temporal = await open('#size=320x180&b=taa&pixel=150,60');
  await temporal.until('document.querySelectorAll(".samples figure").length === 2');
  assert.match(await temporal.evaluate('document.querySelector(".samples figure:last-child").textContent'), /averages frames/);
});

test('a mistake is one line', async () => {
  const page = await open('#size=320x180');
  await page.evaluate(() => { const input = document.querySelector('[aria-label="Method B with its parameters"]'); input.value = 'msaa:n=5'; input.dispatchEvent(new Event('change')); });
  await page.until('!document.querySelector(".error").hidden');
  assert.match(await page.evaluate('document.querySelector(".error").textContent'), /msaa/);
});

test('a moving scene plays, and frames are stepped', async () => {
  const page = await open('#scene=passing-fence&b=taa&size=320x180');
  await page.key('.');
  await done(page);
  assert.match(await hashOf(page), /frame=1/);
  await page.key('p');
  await page.until('Number(new URLSearchParams(location.hash.slice(1)).get("frame")) > 3');
  await page.key('p');
  await done(page);
});
