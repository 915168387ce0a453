// Filters the same pictures in Chromium, without a GPU, and by Zoneplate, in turns, and prints times and their ratios.
//
// node drive.mjs PEER_FILTERS MODULES [--size WxH] [--rounds N] [--frames N] [--pictures FOLDER]
//   PEER_FILTERS  the program that filters here (bench/peers/filters.cpp)
//   MODULES       a folder that holds node_modules
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

const [program, modules, ...rest] = process.argv.slice(2);
const option = (name, otherwise) => (rest.includes('--' + name) ? rest[rest.indexOf('--' + name) + 1] : otherwise);
const [width, height] = option('size', '2048x1024').split('x').map(Number);
const rounds = Number(option('rounds', 3)), frames = Number(option('frames', 5));
const pictures = option('pictures', '');
if (!(width > 0 && height > 0 && rounds > 0 && frames > 0)) throw new Error('bad options: ' + rest.join(' '));

const scenes = ['teapot', 'city'];
/// What stands against what; of the first and the last the pictures are compared too.
const cases = [
  { theirs: 'three r137 FXAA 3.11', ours: 'fxaa' },
  { theirs: 'three FXAAPass', ours: 'fxaa' },
  { theirs: 'postprocessing FXAA', ours: 'fxaa' },
  { theirs: 'three SMAAPass', ours: 'smaa' },
  { theirs: 'postprocessing SMAA high', ours: 'smaa' },
];

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'peer-filters-'));
const here = path.dirname(new URL(import.meta.url).pathname);
const codesOf = (scene) => path.join(folder, scene + '.rgba');
const run = (...args) => execFileSync(program, args.map(String), { encoding: 'utf8' });

/// The page asks for work and gives it back; one piece at a time.
let give, take, trouble;
const waiting = [];
const nextWork = (work) => new Promise((done, failed) => {
  take = done, trouble = failed;
  if (give) give(work), give = null;
  else waiting.push(work);
});
const page = `<!doctype html><meta charset="utf-8"><script type="importmap">{"imports": {
  "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/",
  "three-r137/": "/node_modules/three-r137/", "postprocessing": "/node_modules/postprocessing/build/index.js"}}</script>
  <script type="module" src="/page.js"></script>`;
const rendererName = {};
rendererName.known = new Promise((done) => (rendererName.tell = done));

const server = http.createServer((request, response) => {
  const at = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
  const send = (type, body) => (response.writeHead(200, { 'content-type': type }), response.end(body));
  const sendFile = (type, file) => (response.writeHead(200, { 'content-type': type }), fs.createReadStream(file).pipe(response));
  const body = (use) => {
    const parts = [];
    request.on('data', (part) => parts.push(part));
    request.on('end', () => (use(Buffer.concat(parts)), send('text/plain', '')));
  };
  if (at === '/') return send('text/html', page);
  if (at === '/page.js') return sendFile('text/javascript', path.join(here, 'page.js'));
  if (at === '/job') return send('application/json', JSON.stringify({ width, height }));
  if (at === '/work') {
    const answer = (work) => send('application/json', JSON.stringify(work));
    return waiting.length ? answer(waiting.shift()) : void (give = answer);
  }
  if (at === '/done') return body((result) => take(result));
  if (at === '/renderer') return body((name) => rendererName.tell(name.toString()));
  if (at === '/trouble') return body((text) => trouble?.(new Error(text.toString())));
  if (at.startsWith('/scene/')) return sendFile('application/octet-stream', codesOf(path.basename(at)));
  const file = path.join(modules, path.normalize(at));
  if (at.startsWith('/node_modules/') && fs.existsSync(file)) return sendFile('text/javascript', file);
  response.writeHead(404);
  response.end();
});

/// Processor time of a process and all that came from it.
function processorMs(root) {
  const children = {}, ticks = {};
  for (const pid of fs.readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const fields = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /s, '').split(' ');
      (children[fields[1]] ??= []).push(pid);
      ticks[pid] = Number(fields[11]) + Number(fields[12]);
    } catch { /* it ended meanwhile */ }
  }
  const sum = (pid) => (ticks[pid] ?? 0) + (children[pid] ?? []).reduce((all, child) => all + sum(child), 0);
  return sum(String(root)) * 10;  // a tick is a hundredth of a second on Linux
}

const least = (ms) => Math.min(...ms);
const median = (ms) => [...ms].sort((a, b) => a - b)[ms.length >> 1];

async function compare(scene, { theirs, ours }, browser) {
  const all = { theirs: [], ours: [] }, processor = { theirs: 0, ours: 0 };
  await nextWork({ scene, filter: theirs, frames: 1 });
  for (let round = 0; round < rounds; ++round) {
    const before = processorMs(browser.pid);
    all.theirs.push(...JSON.parse(await nextWork({ scene, filter: theirs, frames })));
    processor.theirs += processorMs(browser.pid) - before;
    const result = JSON.parse(run('time', ours, width, height, codesOf(scene), 4 * frames));
    all.ours.push(...result.ms);
    processor.ours += result.processor_ms;
  }
  const picture = path.join(folder, 'theirs.rgba');
  fs.writeFileSync(picture, await nextWork({ scene, filter: theirs }));
  const name = pictures && path.join(pictures, `${scene}-${theirs.replaceAll(' ', '-')}`);
  const off = JSON.parse(run('distance', ours, width, height, codesOf(scene), picture, name));
  const cell = (value, size) => value.toFixed(value < 100 ? 1 : 0).padStart(size);
  const n = all.theirs.length;
  console.log(`${scene.padEnd(8)}${theirs.padEnd(26)}` +
    cell(least(all.theirs), 8) + cell(median(all.theirs), 8) + cell(processor.theirs / n, 9) + '  ' +
    cell(least(all.ours), 8) + cell(median(all.ours), 8) + cell(processor.ours / all.ours.length, 9) + '  ' +
    cell(least(all.theirs) / least(all.ours), 8) + cell(median(all.theirs) / median(all.ours), 8) +
    cell((processor.theirs / n) / (processor.ours / all.ours.length), 8) + '   ' +
    `${off.changed_percent.toFixed(2)} ${off.theirs_percent.toFixed(2)} ${off.differing_percent.toFixed(3)}`);
}

if (pictures) fs.mkdirSync(pictures, { recursive: true });
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const flags = ['--headless=new', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
  `--user-data-dir=${path.join(folder, 'profile')}`];
if (process.getuid() === 0) flags.push('--no-sandbox');
let browser;
process.on('SIGINT', () => process.exit(130));
process.on('SIGTERM', () => process.exit(143));
process.on('exit', () => {
  browser?.kill('SIGKILL');
  fs.rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
});
try {
  for (const scene of scenes) run('draw', scene, width, height, codesOf(scene));
  browser = spawn('chromium', [...flags, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
  const late = setTimeout(() => { console.error('Chromium does not answer'); process.exit(1); }, 60000);
  console.log(`${await rendererName.known}\n${width}x${height}, ${rounds} rounds of ${frames} frames; milliseconds a frame`);
  clearTimeout(late);
  console.log(''.padEnd(34) + 'peer: least, median, processor   Zoneplate: the same        ratios of the three' +
    '        changed %: here, there; pixels that differ by more than 1, %');
  for (const scene of scenes)
    for (const c of cases) await compare(scene, c, browser);
} finally {
  browser?.kill();
  if (browser) await new Promise((done) => browser.on('exit', done));
  process.exit(process.exitCode);
}
