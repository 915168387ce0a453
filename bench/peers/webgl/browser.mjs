// A page in headless Chromium without a GPU (SwiftShader) that fetches pieces of work from a server in this process, and
// posts a result for each.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

const here = path.dirname(new URL(import.meta.url).pathname);

/// Processor time of a process and all that came from it.
export function processorMs(root) {
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

export const least = (ms) => Math.min(...ms);
export const median = (ms) => [...ms].sort((a, b) => a - b)[ms.length >> 1];
/// A number in a column, with a digit after the point where it is below 100.
export const cell = (value, size) => value.toFixed(value < 100 ? 1 : 0).padStart(size);

/// Runs `work` with a page that runs `script` (a file of this folder). `modules` is a folder that holds node_modules,
/// `job` what the page reads at /job, and `files` maps a path beginning with /file/ to a file. `work` gets an object of
/// `folder` (for temporary files), `renderer` (the page's name of it), `ask` (gives the page work, and returns what it
/// answers) and `pid` (of the browser).
export async function withPage({ script, modules, job, files }, work) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'peer-webgl-'));
  let give, take, trouble;
  const waiting = [];
  const ask = (piece) => new Promise((done, failed) => {
    take = done, trouble = failed;
    if (give) give(piece), give = null;
    else waiting.push(piece);
  });
  const page = `<!doctype html><meta charset="utf-8"><script type="importmap">{"imports": {
    "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/",
    "three-r137/": "/node_modules/three-r137/", "postprocessing": "/node_modules/postprocessing/build/index.js"}}</script>
    <script type="module" src="/${script}"></script>`;
  let nameRenderer;
  const renderer = new Promise((done) => (nameRenderer = done));

  const server = http.createServer((request, response) => {
    const at = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const send = (type, body) => (response.writeHead(200, { 'content-type': type }), response.end(body));
    const missing = () => (response.writeHead(404), response.end());
    const sendFile = (type, file) => {
      if (!file || !fs.existsSync(file)) return missing();
      response.writeHead(200, { 'content-type': type });
      fs.createReadStream(file).pipe(response);
    };
    const body = (use) => {
      const parts = [];
      request.on('data', (part) => parts.push(part));
      request.on('end', () => (use(Buffer.concat(parts)), send('text/plain', '')));
    };
    if (at === '/') return send('text/html', page);
    if (at === '/' + script) return sendFile('text/javascript', path.join(here, script));
    if (at === '/job') return send('application/json', JSON.stringify(job));
    if (at === '/work') {
      const answer = (piece) => send('application/json', JSON.stringify(piece));
      return waiting.length ? answer(waiting.shift()) : void (give = answer);
    }
    if (at === '/done') return body((result) => take(result));
    if (at === '/renderer') return body((name) => nameRenderer(name.toString()));
    if (at === '/trouble') return body((text) => trouble?.(new Error(text.toString())));
    if (at.startsWith('/file/')) return sendFile('application/octet-stream', files(at.slice('/file/'.length), folder));
    if (at.startsWith('/node_modules/')) return sendFile('text/javascript', path.join(modules, path.normalize(at)));
    missing();
  });

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
    fs.rmSync(folder, { recursive: true, force: true, maxRetries: 20 });  // processes of the browser may still write
  });
  try {
    browser = spawn('chromium', [...flags, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
    const late = setTimeout(() => { console.error('Chromium does not answer'); process.exit(1); }, 60000);
    const name = await renderer;
    clearTimeout(late);
    await work({ folder, renderer: name, ask, pid: browser.pid });
  } finally {
    browser?.kill();
    if (browser) await new Promise((done) => browser.on('exit', done));
    process.exit(process.exitCode);
  }
}
