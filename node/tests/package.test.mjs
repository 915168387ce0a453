// SPDX-License-Identifier: Apache-2.0
// The package in Node: its bytes are those of the native program.
//
//   ZONEPLATE=build/check/zoneplate ZONEPLATE_NODE=build/web/node node --test node/tests/package.test.mjs
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { glbOf, gltfOf, waveGlb, writeModels } from '../../web/test/models.mjs';
import { archive, install, program } from './install.mjs';

const folder = install(), at = (name) => path.join(folder, name);
const home = process.cwd();
let zoneplate;

/// The bytes that the program writes for a model.
function native(model, file, ...options) {
  execFileSync(program, ['render', model, '-o', file, '--quiet', ...options], { cwd: folder });
  return fs.readFileSync(at(file));
}

before(async () => {
  process.chdir(folder);
  zoneplate = await import(pathToFileURL(at('node_modules/zoneplate/index.js')).href);
  writeModels(folder);
  execFileSync(program, ['render', 'teapot', '--size', '37x29', '-o', 'face.jpg', '--quiet'], { cwd: folder });
  execFileSync(program, ['render', 'teapot', '--size', '37x29', '-o', 'face.webp', '--no-background', '--quiet'], { cwd: folder });
  for (const [name, type] of [['jpg', 'image/jpeg'], ['webp', 'image/webp']])
    fs.writeFileSync(at(`${name}.glb`), glbOf(gltfOf(fs.readFileSync(at(`face.${name}`)), type)));
  fs.writeFileSync(at('wave.glb'), waveGlb(71));
});
after(() => {
  process.chdir(home);
  zoneplate.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

test('the archive is small, and has no scripts or dependencies', () => {
  const { size } = fs.statSync(archive), about = JSON.parse(fs.readFileSync(at('node_modules/zoneplate/package.json')));
  console.log(`archive: ${size} bytes`);
  assert.ok(size < 4e6, `${size} bytes`);
  assert.equal(about.scripts, undefined);
  assert.equal(about.dependencies, undefined);
  const version = execFileSync(program, ['--version'], { encoding: 'utf8' });
  assert.ok(version.includes(about.version), version);
});

const size = [160, 120], native160 = ['--size', '160x120'];
for (const model of ['square.glb', 'square.gltf', 'square.obj', 'square.ply', 'square.stl', 'jpg.glb', 'webp.glb', 'wave.glb', 'teapot'])
  test(`the bytes of the program: ${model}`, async () => {
    const image = await zoneplate.render(model, { size });
    assert.deepEqual([image.width, image.height, image.warnings], [160, 120, []]);
    assert.ok(native(model, 'native.png', ...native160).equals(image.data));
  });

const variants = [
  [{ aa: 'smaa' }, ['--aa', 'smaa']],
  [{ aa: 'ssaa:n=4', background: '#204060' }, ['--aa', 'ssaa:n=4', '--background', '#204060']],
  [{ transparent: true, exposure: 0.5, toneMapping: 'aces' }, ['--no-background', '--exposure', '0.5', '--tone-mapping', 'aces']],
  [{ view: { azimuth: -70, elevation: 35, verticalFov: 40 } }, ['--camera-azimuth-angle', '-70', '--camera-elevation-angle', '35', '--camera-view-angle', '40']],
  [{ view: { position: [2, 1.5, 3], focalPoint: [0, 0.1, 0] } }, ['--camera-position', '2,1.5,3', '--camera-focal-point', '0,0.1,0']],
  [{ shadows: 'hard', environment: '#8090a0' }, ['--shadows', 'hard', '--environment', '#8090a0']],
  [{ crop: [40, 30, 50, 41], dtype: 'uint16' }, ['--crop', '40,30,50,41', '--bit-depth', '16']],
];
for (const [options, flags] of variants)
  test(`the bytes of the program: ${flags.join(' ')}`, async () => {
    const image = await zoneplate.render('wave.glb', { size, ...options });
    assert.ok(native('wave.glb', 'native.png', ...native160, ...flags).equals(image.data));
  });

test('other files have the bytes of the program too', async () => {
  for (const output of ['jpg', 'webp', 'pfm']) {
    const { data } = await zoneplate.render('jpg.glb', { size, output, dtype: output === 'pfm' ? 'float32' : 'uint8' });
    assert.ok(native('jpg.glb', `native.${output}`, ...native160).equals(data), output);
  }
  const { data } = await zoneplate.render('jpg.glb', { size, output: 'exr', dtype: 'float32' });
  fs.writeFileSync(at('made.exr'), data);
  native('jpg.glb', 'native.pfm', ...native160);
  const { stdout } = spawnSync(program, ['metrics', 'native.pfm', 'made.exr', '--metric', 'mse', '--json'], { cwd: folder });
  assert.ok(JSON.parse(stdout).metrics.mse.value < 1e-8); // of 16-bit floats
});

test('pixels and data passes', async () => {
  const { data, arrays, width, height } = await zoneplate.render('wave.glb', { size, output: 'pixels', aovs: ['depth', 'normal', 'object-id'] });
  assert.ok(native('wave.glb', 'native.rgba', ...native160).equals(data));
  assert.equal(data.length, 4 * width * height);
  assert.deepEqual(Object.entries(arrays).map(([name, { shape, data: values }]) => [name, shape, values.constructor.name]),
    [['depth', [120, 160], 'Float32Array'], ['normal', [120, 160, 3], 'Float32Array'], ['object-id', [120, 160], 'Uint32Array']]);
  assert.equal(arrays.depth.data[0], Infinity);
  assert.equal(arrays['object-id'].data[60 * 160 + 80], 0);
  const linear = await zoneplate.render('wave.glb', { size, output: 'pixels', dtype: 'float32' });
  assert.equal(linear.data.constructor.name, 'Float32Array');
});

test('models in memory, with their other files', async () => {
  const bytes = (name) => fs.readFileSync(at(name));
  const files = Object.fromEntries(['square.gltf', 'square.bin', 'face.png'].map((name) => [name, bytes(name)]));
  const expected = native('square.gltf', 'native.png', ...native160);
  assert.ok(expected.equals((await zoneplate.render('square.gltf', { size, files })).data));
  assert.ok(expected.equals((await zoneplate.render(pathToFileURL(at('square.gltf')), { size })).data));
  assert.ok(native('square.glb', 'native.png', ...native160).equals((await zoneplate.render(bytes('square.glb'), { size })).data));
  assert.ok(native('square.stl', 'native.png', ...native160).equals((await zoneplate.render(bytes('square.stl'), { size, format: 'stl' })).data));
  fs.mkdirSync(at('links'), { recursive: true });
  fs.symlinkSync(at('square.glb'), at('links/link.glb'));
  assert.ok(native('square.glb', 'native.png', ...native160).equals((await zoneplate.render('links/link.glb', { size })).data));
});

test('info is that of the program', async () => {
  for (const model of ['square.obj', 'jpg.glb', 'teapot']) {
    const { format, version, input, ...expected } = JSON.parse(execFileSync(program, ['info', model, '--json'], { cwd: folder }));
    const found = await zoneplate.info(model);
    assert.deepEqual(found, expected);
    assert.equal(`${model}\n${found.text}`, execFileSync(program, ['info', model], { cwd: folder, encoding: 'utf8' }));
  }
});

test('compare has the values of the program', async () => {
  native('wave.glb', 'a.png', ...native160);
  native('wave.glb', 'b.png', ...native160, '--aa', 'none');
  const { metrics } = JSON.parse(spawnSync(program, ['metrics', 'a.png', 'b.png', '--json'], { cwd: folder }).stdout);
  const found = await zoneplate.compare('a.png', 'b.png');
  assert.deepEqual(Object.keys(found.metrics), Object.keys(metrics));
  for (const [name, { value }] of Object.entries(metrics)) assert.equal(found.metrics[name].value, value, name);
  assert.equal(found.identical, false);
  const made = await zoneplate.render('wave.glb', { size, output: 'pixels' }), file = await zoneplate.render('wave.glb', { size, aa: 'none' });
  const again = await zoneplate.compare(made, file, { metrics: ['psnr', 'flip'] });
  for (const name of ['psnr', 'flip']) assert.equal(again.metrics[name].value, metrics[name].value, name);
  assert.equal(again.map.length, 160 * 120);
  assert.equal((await zoneplate.compare('a.png', made, { metrics: ['psnr'] })).metrics.psnr.value, Infinity);
  const ignored = await zoneplate.compare('a.png', 'b.png', { metrics: ['pixels'], ignore: [[0, 0, 160, 100]] });
  assert.ok(ignored.metrics.pixels.figures.pixels < found.metrics.mse.figures.rmse * 160 * 120);
});

test('an error is one line with the file and the cause, and others still work', async () => {
  const rejects = (promise, code, text) => assert.rejects(promise, (error) => error instanceof zoneplate.ZoneplateError && error.code === code && text.test(error.message) && !error.message.includes('\n'));
  await rejects(zoneplate.render('none.glb'), 'input', /^none\.glb: no such file/);
  fs.writeFileSync(at('broken.glb'), fs.readFileSync(at('square.glb')).subarray(0, 300));
  await rejects(zoneplate.render('broken.glb'), 'input', /^broken\.glb: /);
  await rejects(zoneplate.render(at('broken.glb')), 'input', new RegExp(`^${at('broken.glb')}: `));
  await rejects(zoneplate.render('teapot', { antialias: 'smaa' }), 'usage', /^antialias: there is no such option$/);
  await rejects(zoneplate.render('teapot', { aa: 'smooth' }), 'usage', /smooth/);
  await rejects(zoneplate.render('teapot', { size: [0, 10] }), 'usage', /^size: /);
  await rejects(zoneplate.render('wave.glb', { maxMemory: 100000 }), 'input', /^wave\.glb: .*100/);
  await rejects(zoneplate.render('teapot', { size: [30000, 30000] }), 'usage', /^size: .*30000/);
  fs.copyFileSync(at('square.gltf'), at('alone.gltf'));
  fs.mkdirSync(at('apart'), { recursive: true });
  fs.renameSync(at('alone.gltf'), at('apart/alone.gltf'));
  await rejects(zoneplate.render('apart/alone.gltf'), 'input', /square\.bin/);
  fs.writeFileSync(at('outside.gltf'), fs.readFileSync(at('square.gltf'), 'utf8').replace('square.bin', '../../../../../etc/passwd'));
  await rejects(zoneplate.render('outside.gltf'), 'input', /passwd/);
  execFileSync(program, ['render', 'teapot', '-o', 'film.apng', '--size', '16', '--turntable', '2', '--quiet'], { cwd: folder });
  await rejects(zoneplate.compare('film.apng', 'film.apng'), 'input', /^film\.apng: is an animation/);
  await assert.rejects(zoneplate.render(42), TypeError);
  await assert.rejects(zoneplate.render('wave.glb', { files: {} }), /files: has no 'wave\.glb'/);
  const { width } = await zoneplate.render('teapot', { size: [8, 8] });
  assert.equal(width, 8);
});

test('a module that fails is replaced, and the request is answered', async () => {
  const { Pool } = createRequire(import.meta.url)(at('node_modules/zoneplate/pool.cjs'));
  let started = 0;
  const pool = new Pool((listener) => {
    const number = ++started;
    return {
      post: (message) => queueMicrotask(() => (message === 'end' ? listener.fail(new Error('ended')) : listener.answer({ number, isSpent: message === 'trap' }))),
      stop() {}, hold() {},
    };
  }, 1);
  assert.deepEqual(await Promise.all([pool.ask('a'), pool.ask('trap'), pool.ask('b')]).then((replies) => replies.map(({ number }) => number)), [1, 1, 2]);
  await assert.rejects(pool.ask('end'), /ended/);
  assert.equal((await pool.ask('c')).number, 3);

  // A trap: a function of one instruction, `unreachable`, in place of the renderer.
  const { makeEngine } = await import(pathToFileURL(at('node_modules/zoneplate/engine.js')).href);
  const code = new WebAssembly.Module(Uint8Array.of(0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, 4, 1, 0x60, 0, 0, 3, 2, 1, 0, 7, 5, 1, 1, 0x66, 0, 0, 0x0a, 5, 1, 3, 0, 0, 0x0b));
  const none = () => {}, FS = { writeFile: none, mkdir: none, mkdirTree: none, chdir: none, readdir: () => [] };
  const answer = await makeEngine(async () => ({ FS, HEAPU8: new Uint8Array(1 << 16), _malloc: () => 8, _free: none, _zoneplate_answer: new WebAssembly.Instance(code).exports.f }), code, new Uint8Array());
  assert.deepEqual(answer({ verb: 'render', model: 'teapot', files: {} }), { error: 'teapot: the renderer failed: unreachable', status: 1, isSpent: true });
});

test('several renders at once have the same bits', async () => {
  const expected = native('wave.glb', 'native.png', ...native160);
  const images = await Promise.all(Array.from({ length: 12 }, () => zoneplate.render('wave.glb', { size })));
  for (const { data } of images) assert.ok(expected.equals(data));
});

test('200 renders in one worker take no more memory', async () => {
  zoneplate.close();
  zoneplate.setWorkers(1);
  const memory = [], times = [];
  let used;
  for (let i = 0; i < 220; ++i) {
    if (i === 20) used = process.cpuUsage();
    const begin = performance.now();
    await zoneplate.render('wave.glb', { size: [512, 512] });
    times.push(performance.now() - begin);
    if (i === 19 || i === 219) {
      globalThis.gc?.();
      memory.push(process.memoryUsage().rss);
    }
  }
  const { user, system } = process.cpuUsage(used);
  const growth = (memory[1] - memory[0]) / 2 ** 20, sorted = times.slice(20).sort((a, b) => a - b);
  console.log(`10,082 triangles at 512 x 512: first ${times[0].toFixed(0)} ms, then median ${sorted[100].toFixed(0)} ms, least ${sorted[0].toFixed(0)} ms, processor ${((user + system) / 200e3).toFixed(0)} ms; growth ${growth.toFixed(1)} MiB of ${(memory[0] / 2 ** 20).toFixed(0)}`);
  assert.ok(growth < 32, `${growth} MiB`);
  assert.ok((user + system) / 200e3 < 150, 'processor time per render'); // of all threads: it does not depend on others' load
});

test('npx zoneplate', () => {
  const run = (...args) => {
    const { status, stdout, stderr } = spawnSync(at('node_modules/.bin/zoneplate'), args, { cwd: folder });
    return { status, stdout, stderr: stderr.toString() };
  };
  assert.equal(run('wave.glb', '-o', 'made.png', '--size', '160x120', '--aa', 'smaa').stderr, '');
  assert.ok(native('wave.glb', 'native.png', ...native160, '--aa', 'smaa').equals(fs.readFileSync(at('made.png'))));
  assert.ok(native('wave.glb', 'native.png', ...native160).equals(run('render', 'wave.glb', '--size=160,120', '-o', '-').stdout));
  assert.equal(run('teapot', '-o', 'turn.##.png', '--size', '16', '--turntable', '2', '--section', '1,0,0,0', '--section', '0,0,1,0').stderr, '');
  for (const name of ['turn.00.png', 'turn.01.png']) assert.ok(fs.statSync(at(name)).size > 100, name);
  assert.equal(run('info', 'square.obj').stdout.toString(), execFileSync(program, ['info', 'square.obj'], { cwd: folder, encoding: 'utf8' }));
  assert.equal(run('metrics', 'made.png', 'made.png').status, 0);
  const differ = run('metrics', 'made.png', 'native.png', '--metric', 'psnr,flip:ppd=30', '--json');
  assert.equal(differ.status, 1);
  assert.deepEqual(Object.keys(JSON.parse(differ.stdout).metrics), ['psnr', 'flip']);
  const halves = run('metrics', 'made.png', 'native.png', '--metric', 'mae', '--ignore', '0,0,80,120', '--ignore=80,0,40,120', '--json');
  const half = run('metrics', 'made.png', 'native.png', '--metric', 'mae', '--ignore', '0,0,80,120', '--json');
  assert.notDeepEqual(JSON.parse(halves.stdout).metrics, JSON.parse(half.stdout).metrics);
  const verbs = /local verbs='([^']+)'/.exec(execFileSync(program, ['completions', 'bash'], { encoding: 'utf8' }))[1].split(' ');
  assert.ok(verbs.length > 10);
  for (const verb of verbs)
    if (!['render', 'info', 'metrics', 'list'].includes(verb)) assert.match(run(verb, 'a').stderr, /no verb of this package/, verb);
  assert.match(run('list', 'methods').stdout.toString(), /^smaa /m);
  for (const [args, status, text] of [[['compare', 'teapot'], 2, /compare: no verb of this package; the native program zoneplate has it/],
    [['teapot', '-o', 'a.png', '--turntable', '4'], 2, /a\.png: several frames require a frame number/], [['teapot', '-o', 'a.png', '--threads', '2'], 2, /no option '--threads' in this package/], [['none.glb', '-o', 'a.png'], 3, /none\.glb: no such file/],
    [['teapot', '-o', 'a.png', '--no-background=0'], 2, /--no-background: takes no value/],
    [['teapot', '-o', 'none/a.png'], 4, /none\/a\.png/], [['teapot', '-o', 'a.gif', '--size', '8'], 3, /films of this format are encoded by the program, not by this package/]]) {
    const found = run(...args);
    assert.equal(found.status, status, found.stderr);
    assert.match(found.stderr, text);
    assert.equal(found.stderr.trim().split('\n').length, 1, found.stderr);
  }
});

test('CommonJS has the same functions', () => {
  const text = `const z = require('zoneplate'); z.render('wave.glb', { size: [16, 16] }).then(({ width }) => console.log(width, Object.keys(z).join()));`;
  assert.equal(execFileSync(process.execPath, ['-e', text], { cwd: folder, encoding: 'utf8' }), '16 render,renderFiles,info,compare,list,setWorkers,close,ZoneplateError\n');
});
