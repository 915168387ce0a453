// The playground in Chromium: its images are those of the native program.
//
//   ZONEPLATE=build/check/zoneplate SITE=build/web/site node --test web/test/playground.test.mjs
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import zlib from 'node:zlib';
import { Browser } from './browser.mjs';
import { pairsOf } from '../playground/state.js';
import { ktx2File, writeModels } from './models.mjs';
import { copyOptionFiles, optionFiles, optionRows } from './options.mjs';
import { readPage, writeHdr } from './pictures.mjs';
import { serve } from './server.mjs';

const program = path.resolve(process.env.ZONEPLATE ?? 'build/check/zoneplate');
const site = path.resolve(process.env.SITE ?? 'build/web/site');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-playground-'));
const nativeImages = new Map();
/// The bytes that the program writes for an image, four for each pixel.
function nativeImage(scene, method, size, ...options) {
  const args = ['render', scene, '-o', 'image.rgba', '--size', size.join(), '--aa', method, '--quiet', ...options], key = args.join(' ');
  if (!nativeImages.has(key)) {
    execFileSync(program, args, { cwd: folder });
    nativeImages.set(key, fs.readFileSync(path.join(folder, 'image.rgba')));
  }
  return nativeImages.get(key);
}

let browser, server, isolatedServer;
const opened = [];
async function open(hash = '', from = server) {
  const page = await browser.page();
  opened.push({ page, hash });
  await page.open(`${from.address}/playground/index.html${hash}`);
  await done(page);
  return page;
}
const done = async (page) => { await page.until('document.getElementById("app").dataset.done === "true"', 60); await page.settle(); };
/// The address, which follows within a third of a second.
const hashOf = async (page) => { await new Promise((wait) => setTimeout(wait, 400)); return page.evaluate('decodeURIComponent(location.hash)'); };

before(async () => { browser = new Browser(), server = await serve(site), isolatedServer = await serve(site, { isIsolated: true }); });
after(async () => {
  for (const { page, hash } of opened) assert.deepEqual(page.problems, [], `problems of the page ${hash}`);
  await browser.close();
  await server.close();
  await isolatedServer.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

/// A job of renderAll: options of rendering as in the address of the page.
const jobOf = ({ scene, width, height, method, look = '' }) => ({ scene, options: [['resolution', `${width},${height}`], ['anti-aliasing', method], ...pairsOf(look)] });

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
    const images = await renderAll(page, jobs.map(jobOf));
    jobs.forEach(({ method }, i) => assert.ok(Buffer.from(images[i].bytes, 'base64').equals(nativeImage(scene, method, [width, height])), `${scene} by ${method}`));
  }
});

test('threads render the same bytes, where the page is cross-origin isolated', async (t) => {
  await open('#size=320x180');
  const page = await open('#size=320x180', isolatedServer), [width, height] = [128, 72];
  const modules = (paths) => [...new Set(paths.filter((name) => name.endsWith('.wasm')))];
  assert.equal(await page.evaluate('crossOriginIsolated'), true);
  assert.deepEqual(modules(isolatedServer.paths), ['/playground/threads/zoneplate_playground.wasm']);
  assert.deepEqual(modules(server.paths), ['/playground/zoneplate_playground.wasm']);
  const { methods, upscalers } = await page.evaluate(async () => new (await import('./renderer.js')).Renderer().ask('catalogue'));
  const restart = (threads) => page.evaluate(async (count) => { window.testRenderer?.worker.terminate(), window.testScene = undefined, window.testRenderer = new (await import('./renderer.js')).Renderer(count); }, threads);
  for (const threads of [2, 7]) {
    await restart(threads);
    for (const scene of ['teapot', 'foliage', 'passing-fence']) {
      const jobs = [...methods, ...(threads === 2 ? upscalers : [])].map(({ name }) => ({ scene, width, height, method: name }));
      const images = await renderAll(page, jobs.map(jobOf));
      jobs.forEach(({ method }, i) => assert.ok(Buffer.from(images[i].bytes, 'base64').equals(nativeImage(scene, method, [width, height])), `${scene} by ${method}, ${threads} threads`));
    }
    const lessons = ['sampling', 'shadows', 'texture-filters', 'upscaling'], drawn = await drawLessons(page, lessons, 64), native = await nativeLessons(lessons, 64, drawn);
    drawn.forEach((scene, i) => assert.deepEqual(withoutPlots(scene), withoutPlots(native[i]), `${scene.name}, ${threads} threads`));
  }
  const times = {};
  for (const threads of [1, 2]) {
    await restart(threads);
    for (const method of ['msaa:n=4', 'ssaa:n=4']) {
      const all = (await renderAll(page, Array(12).fill(jobOf({ scene: 'teapot', width: 640, height: 360, method })))).map(({ ms }) => ms).sort((a, b) => a - b);
      (times[method] ??= []).push(all[0]);
      t.diagnostic(`teapot, 640 × 360, ${method}, ${threads} threads: ${all[0].toFixed(1)} ms, median ${all[6].toFixed(1)} ms`);
    }
  }
  // Machines of one processor gain nothing, and a busy one little.
  for (const [method, [one, two]] of Object.entries(times)) assert.ok(two < 1.3 * one, `${method}: ${one} ms by one thread, ${two} ms by two`);
});

test('frames of sequences and cameras have the same bytes as those that the stated command makes', async () => {
  const page = await open('#size=320x180');
  const cases = [['passing-fence', 'taa', '5'], ['passing-fence', 'msaa:n=4', '30'], ['wires', 'taa', '2'], ['teapot', 'smaa', '60'], ['teleport', 'taa', '40'],
    ['teapot', 'msaa:n=4', '', '', { azimuth: '75.5', elevation: '-12.25', angle: '18' }], ['teapot', 'none', '30', 'turntable=60;shadows=soft:samples=8,angle=5'],
    ['passing-fence', 'none', '3', 'shutter=180;shutter-samples=4'], ['teapot', 'none', '1', 'views=top,iso'], ['teapot', 'msaa:n=4', '', 'quality=best;ground=none']];
  for (const [scene, method, frame, look = '', camera = {}] of cases) {
    const { command, bytes } = await page.evaluate(async (given, chosen) => {
      const { commandOf, optionsOf, readState } = await import('./state.js'), { Renderer } = await import('./renderer.js');
      const state = { ...readState(''), size: '128x72', ...given }, renderer = window.testRenderer ??= new Renderer(), about = await renderer.ask('builtin', state.scene);
      window.testScene = state.scene;
      const { data, has_history: hasHistory } = await renderer.ask('render', { options: optionsOf(state, about, chosen), frame: state.frame === '' ? -1 : Number(state.frame) });
      return { command: commandOf(state, about, { ...chosen, hasHistory, output: 'image.rgba' }), bytes: btoa(String.fromCharCode(...data)) };
    }, { scene, frame, ...camera }, { method, look });
    execFileSync(program, [...command.split(' ').slice(1), '--quiet'], { cwd: folder });
    assert.ok(Buffer.from(bytes, 'base64').equals(fs.readFileSync(path.join(folder, 'image.rgba'))), command);
  }
});

test('every row of the table of options has the same bytes as in the program, or is refused by name', async () => {
  const page = await open('#size=320x180'), rows = optionRows(), place = path.join(folder, 'options'), isSequence = ([name]) => ['turntable', 'views', 'camera-path', 'frame-rate', 'shutter'].includes(name);
  copyOptionFiles(place);
  // Frames are chosen by the page: a row of a sequence is displayed at frame 1, or, for turntable and views, which have few, too.
  const jobs = rows.map(({ name, model, options }) => ({ name, model, frame: options.some(isSequence) ? 1 : -1, options: options.filter(([other]) => other === name || !/^frames$|^frame-start$/.test(other)) }));
  const { names, answers } = await page.evaluate(async (list, files) => {
    const { Renderer } = await import('./renderer.js'), renderer = new Renderer(), catalogue = await renderer.ask('catalogue'), out = [];
    const all = files.map(({ path: name, text }) => ({ path: name, bytes: Uint8Array.from(atob(text), (c) => c.charCodeAt(0)) }));
    await renderer.ask('files', all);
    for (const { model, options, frame } of list) {
      const own = all.find(({ path: name }) => name === model);
      if (own) await renderer.ask('model', [own, ...all.filter((file) => file !== own)]);
      else await renderer.ask('builtin', model);
      out.push(await renderer.ask('render', { options, frame }).then(({ data }) => ({ bytes: btoa(String.fromCharCode(...data)) }), (error) => ({ error: error.message })));
    }
    renderer.worker.terminate();
    return { names: catalogue.options.map(({ name }) => name), answers: out };
  }, jobs, optionFiles().map(({ path: name, bytes }) => ({ path: name, text: bytes.toString('base64') })));
  const refused = rows.map(({ name }) => name).filter((name) => !names.includes(name));
  assert.deepEqual(refused, ['bit-depth', 'jpeg-quality', 'webp-quality', 'png-compression', 'exr-compression', 'aov', 'frames', 'frame-start', 'frame-end', 'frame-jump', 'warm-up',
    'threads', 'isa', 'allow-path', 'max-memory', 'sandbox']);
  jobs.forEach(({ name, model, frame, options }, i) => {
    if (refused.includes(name)) return assert.match(answers[i].error ?? '', new RegExp(`^${name}: `), name);
    const range = frame < 0 ? [] : ['--frame-start', String(frame), '--frame-end', String(frame)];
    execFileSync(program, ['render', model, '-o', 'image.rgba', '--quiet', '--no-cache', ...options.map(([key, value]) => (value === '' ? `--${key}` : `--${key}=${value}`)), ...range], { cwd: place });
    assert.equal(answers[i].error, undefined, name);
    return assert.ok(Buffer.from(answers[i].bytes, 'base64').equals(fs.readFileSync(path.join(place, 'image.rgba'))), name);
  });
});

test('options are chosen in the page, and the address and the command have them', async () => {
  const page = await open('#size=320x180&lookb=edges=mesh;no-cull'), shown = () => page.evaluate(() => [...document.querySelectorAll('.command code')].map((code) => code.textContent).join());
  assert.match(await shown(), /-o b\.png --resolution 320,180 --anti-aliasing msaa:n=4 --edges mesh --no-cull$/);
  const choose = async (name, set) => {
    await page.evaluate((id, text) => { const field = document.getElementById(id); document.getElementById('app').dataset.done = 'false'; if (field.type === 'checkbox') field.checked = text !== ''; else field.value = text; field.dispatchEvent(new Event('change')); }, `lookb-${name}`, set);
    await done(page);
  };
  await choose('shadows', 'soft:samples=4,angle=5');
  await choose('no-cull', '');
  assert.equal(await hashOf(page), '#size=320x180&lookb=edges=mesh;shadows=soft:samples=4,angle=5');
  await choose('shadows', 'sift');
  assert.match(await page.evaluate('document.querySelector(".error").textContent'), /^shadows: /);
  await choose('shadows', '');
  assert.equal(await page.evaluate('document.querySelector(".error").textContent'), '');
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

/// Draws lessons of the program in the page: their scenes, with a digest of every image in place of its index.
const drawLessons = (page, texts, panel) => page.evaluate(async (list, size) => {
  const { Renderer } = await import('./renderer.js'), renderer = window.testRenderer ??= new Renderer(), out = [];
  for (const text of list) {
    const { scene, images } = await renderer.ask('figure', text, size), digests = [];
    for (const { width, height, data } of images)
      digests.push(`${width}x${height} ${[...new Uint8Array(await crypto.subtle.digest('SHA-256', data))].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`);
    out.push({ ...scene, images: scene.images.map((image) => ({ ...image, frames: image.frames.map((i) => digests[i]) })) });
  }
  return out;
}, texts, panel);

/// The same from a page that the program writes, without the images that the playground draws as plots.
async function nativeLessons(texts, panel, drawn) {
  const out = [];
  for (const text of texts) {
    execFileSync(program, ['demo', text, '--panel', String(panel), '--html', 'lesson.html'], { cwd: folder, stdio: 'ignore' });
    const { content, pictures } = await readPage(path.join(folder, 'lesson.html'));
    for (const scene of content.scenes) {
      const plots = (drawn[out.length].plots ?? []).map(({ name }) => name);
      const digest = ({ width, height, data }) => `${width}x${height} ${createHash('sha256').update(data).digest('hex')}`;
      out.push({ ...scene, images: scene.images.filter(({ name }) => !plots.includes(name)).map((image) => ({ ...image, frames: image.frames.map((i) => digest(pictures[i])) })) });
    }
  }
  return out;
}
const withoutPlots = ({ plots, chosen, ...scene }) => scene;

test('every lesson of the program has the same bytes, captions and tables', async () => {
  const page = await open('#demo=rasterization&panel=120');
  const { figures } = await page.evaluate(async () => new (await import('./renderer.js')).Renderer().ask('catalogue'));
  assert.ok(figures.length >= 29);
  const others = ['sampling:rate=1.6', 'rasterization:x=0.3', 'sdf:soft=40,texels=20', 'blinn-phong:p=7'];
  const drawn = await drawLessons(page, [...figures.map(({ name }) => name), ...others], 64);
  const native = await nativeLessons(['all', ...others], 64, drawn);
  assert.equal(drawn.length, native.length);
  drawn.forEach((scene, i) => assert.deepEqual(withoutPlots(scene), withoutPlots(native[i]), scene.name));
  assert.ok(drawn.some(({ plots }) => plots?.every(({ plot }) => plot.curves.some(({ points }) => points.length > 1))));
});

test('every parameter of a lesson changes it', async () => {
  const page = await open('#demo=rasterization&panel=120');
  const { figures } = await page.evaluate(async () => new (await import('./renderer.js')).Renderer().ask('catalogue'));
  const changed = figures.flatMap(({ name, params }) => params.map(({ name: key, names, choices, high }) => ({ name, text: `${name}:${key}=${names.at(-1) ?? choices.at(-1) ?? high}` })));
  assert.ok(changed.length > 20);
  const names = [...new Set(changed.map(({ name }) => name))], plain = await drawLessons(page, names, 64), drawn = await drawLessons(page, changed.map(({ text }) => text), 64);
  changed.forEach(({ name, text }, i) => assert.notDeepEqual(drawn[i], plain[names.indexOf(name)], text));
});

test('a lesson of the program is chosen, changed by keys, restored by its address, and closed', async () => {
  const page = await open('#size=320x180');
  const choose = (value) => page.evaluate((text) => { const list = document.querySelector('[aria-label="Lesson"]'); document.getElementById('app').dataset.done = 'false', list.value = text; list.dispatchEvent(new Event('change')); }, value);
  await choose('demo=rasterization');
  await done(page);
  assert.equal(await hashOf(page), '#demo=rasterization');
  assert.match(await page.evaluate('document.querySelector(".figure [role=status]").textContent'), /^Drawn in/);
  const labels = await page.evaluate('[...document.querySelectorAll(".figure .knobs .field")].map((field) => [field.querySelector("label").textContent, field.querySelector("input, select").labels.length])');
  assert.deepEqual(labels, [['x', 1], ['y', 1]]);
  const before = await page.shot();
  await page.evaluate('document.querySelector(".figure .knobs input[type=range]").focus()');
  for (let i = 0; i < 12; ++i) await page.key('ArrowRight');
  await page.until('document.getElementById("app").dataset.done === "true"', 60);
  await page.settle();
  const hash = await hashOf(page);
  assert.match(hash, /^#demo=rasterization:x=0\.\d+$/);
  assert.ok(!Buffer.from((await page.shot()).data).equals(Buffer.from(before.data)));
  assert.match(await page.evaluate('document.querySelector(".figure .command code").textContent'), /^\.\/zoneplate demo rasterization:x=0\.\d+ --panel 240 -o rasterization\.png$/);
  const shown = await page.evaluate('[document.getElementById("figure-x").value, document.querySelector(".figure .words").textContent]');
  await choose('');
  await done(page);
  assert.equal(await page.evaluate('document.querySelector(".figure").hidden'), true);
  assert.match(await page.evaluate('document.querySelector(".show .room .name").textContent'), /./);
  const other = await open(hash);
  assert.equal(await other.evaluate('document.getElementById("figure-x").value'), shown[0]);
  assert.equal(await other.evaluate('document.querySelector(".figure .words").textContent'), shown[1]);
  const wrong = await open('#demo=sampling:rate=7');
  assert.match(await wrong.evaluate('document.querySelector(".error").textContent'), /rate is '7'/);
});

/// A model whose texture is another file.
function writeTextured(name, bytes) {
  const model = JSON.parse(fs.readFileSync(path.join(folder, 'square.gltf'), 'utf8'));
  fs.writeFileSync(path.join(folder, name), bytes);
  fs.writeFileSync(path.join(folder, 'other.gltf'), JSON.stringify({ ...model, images: [{ uri: name }] }));
  return ['other.gltf', 'square.bin', name];
}

test('models of every format have the same bytes as those of the program', async () => {
  const page = await open('#size=320x180');
  const models = [...writeModels(folder), writeTextured('face.ktx2', ktx2File('etc1s_file'))];
  assert.ok(!nativeImage('other.gltf', 'ssaa:n=2', [64, 48]).equals(nativeImage('square.gltf', 'ssaa:n=2', [64, 48])));
  for (const names of models) {
    const files = names.map((name) => ({ path: name, text: fs.readFileSync(path.join(folder, name)).toString('base64') }));
    const text = await page.evaluate(async (list) => {
      const { Renderer } = await import('./renderer.js'), renderer = new Renderer();
      await renderer.ask('model', list.map((file) => ({ path: file.path, bytes: Uint8Array.from(atob(file.text), (c) => c.charCodeAt(0)) })));
      const { data } = await renderer.ask('render', { options: [['resolution', '64,48'], ['anti-aliasing', 'ssaa:n=2']] });
      renderer.worker.terminate();
      return btoa(String.fromCharCode(...data));
    }, files);
    assert.ok(Buffer.from(text, 'base64').equals(nativeImage(names[0], 'ssaa:n=2', [64, 48])), names[0]);
  }
});

/// Opens files as a user chooses them.
const choose = (page, names) => page.evaluate(async (list) => {
  const transfer = new DataTransfer(), input = document.querySelector('input[type="file"]');
  for (const { name, text } of list) transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
  document.getElementById('app').dataset.done = 'false';
  input.files = transfer.files, input.dispatchEvent(new Event('change'));
}, names.map((name) => ({ name, text: fs.readFileSync(path.join(folder, name)).toString('base64') })));

test('a Radiance image lights the scene with the same bytes as in the program, until it is removed', async () => {
  for (const from of [server, isolatedServer]) {
    const page = await open('#scene=metal&size=320x180&a=none&b=msaa:n=4', from);
    writeHdr(path.join(folder, 'sky.hdr'), 64, 32, (x, y) => (Math.hypot(x - 20, y - 8) < 2 ? [200, 190, 180, 136] : y < 16 ? [90, 120, 160 + 2 * y, 128] : [60, 50, 2 * x, 127]));
    const shown = () => page.evaluate(() => [...document.querySelectorAll('.command code')].map((code) => code.textContent).join());
    const imageOf = (look) => page.evaluate(async (text, list) => {
      const { Renderer } = await import('./renderer.js'), renderer = new Renderer(), bytes = Uint8Array.from(atob(list), (c) => c.charCodeAt(0));
      const file = { path: 'sky.hdr', bytes }, other = new Renderer();
      await renderer.ask('environment', await other.ask('prepare', file));
      other.worker.terminate();
      await renderer.ask('files', [file]);
      await renderer.ask('builtin', 'metal');
      const begin = performance.now(), { data } = await renderer.ask('render', { options: [['resolution', '64,48'], ['anti-aliasing', 'msaa:n=4'], ['hdri-file', 'sky.hdr'], ...text] });
      window.testSeconds = (performance.now() - begin) / 1000;
      renderer.worker.terminate();
      return btoa(String.fromCharCode(...data));
    }, look, fs.readFileSync(path.join(folder, 'sky.hdr')).toString('base64'));
    const options = ['--hdri-file', 'sky.hdr', '--no-cache'];
    assert.ok(Buffer.from(await imageOf([]), 'base64').equals(nativeImage('metal', 'msaa:n=4', [64, 48], ...options)));
    assert.ok(Buffer.from(await imageOf([['background', 'environment']]), 'base64').equals(nativeImage('metal', 'msaa:n=4', [64, 48], ...options, '--background', 'environment')));
    const before = await page.shot();
    await choose(page, ['sky.hdr']);
    await done(page);
    assert.match(await shown(), /--hdri-file sky\.hdr/);
    assert.match(await page.evaluate('document.querySelector(".card [role=status]").textContent'), /^Lit by sky\.hdr/);
    const lit = await page.shot();
    assert.ok(!Buffer.from(lit.data).equals(Buffer.from(before.data)));
    await page.evaluate(() => { document.getElementById('app').dataset.done = 'false', [...document.querySelectorAll('button')].find((button) => button.textContent === 'The scene’s own light').click(); });
    await done(page);
    assert.doesNotMatch(await shown(), /hdri/);
  }
});

test('an image that the page does not decode is named with the reason', async () => {
  const page = await open('#size=320x180');
  writeModels(folder);
  for (const [name, bytes, reason] of [['packed.ktx2', ktx2File('zstandard_file'), /packed\.ktx2': data packed by Zstandard are read by the program, not by this page/],
    ['face.exr', Buffer.from([0x76, 0x2f, 0x31, 1, 2, 0, 0, 0]), /face\.exr': OpenEXR images are read by the program/]]) {
    await choose(page, writeTextured(name, bytes));
    await done(page);
    assert.match(await page.evaluate('document.querySelector(".card").textContent'), reason);
  }
});

test('files are opened from the disk, and one that is no model is refused', async () => {
  const page = await open('#size=320x180'), drop = (names) => choose(page, names);
  writeModels(folder);
  await drop(['face.png', 'square.mtl', 'square.obj']);
  await done(page);
  assert.match(await hashOf(page), /scene=square\.obj/);
  assert.match(await page.evaluate('document.querySelector(".card").textContent'), /2 triangles/);
  await drop(['face.png']);
  await page.until('document.querySelector(".card [role=status]").textContent === "Options of rendering may name face.png."');
  await done(page);
  fs.writeFileSync(path.join(folder, 'notes.txt'), 'no model');
  await drop(['notes.txt']);
  await page.until('!document.querySelector(".error").hidden');
});

test('a frame of the teapot takes at most 60 ms', async (t) => {
  const page = await open('#size=320x180');
  const times = (await renderAll(page, Array(20).fill(jobOf({ scene: 'teapot', width: 640, height: 360, method: 'msaa:n=4' })))).map(({ ms }) => ms).sort((a, b) => a - b);
  t.diagnostic(`teapot, 640 × 360, msaa:n=4: ${times[0].toFixed(1)} ms, median ${times[10].toFixed(1)} ms`);
  assert.ok(times[0] <= 60, `${times[0]} ms`);
});

test('each module of the page has at most 1.5 MB after gzip', (t) => {
  for (const name of ['zoneplate_playground.wasm', 'threads/zoneplate_playground.wasm']) {
    const size = zlib.gzipSync(fs.readFileSync(path.join(site, 'playground', name)), { level: 9 }).length;
    t.diagnostic(`${name}: ${size} bytes`);
    assert.ok(size <= 1.5e6, `${name}: ${size} bytes`);
  }
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
