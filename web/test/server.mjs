// A web server of one folder.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.png': 'image/png', '.svg': 'image/svg+xml', '.json': 'application/json' };

/// What makes a page cross-origin isolated (docs/playground.md).
const isolation = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' };

/// { address, paths, close() }; `paths` are those of the requests so far.
export async function serve(folder, { isIsolated = false } = {}) {
  const paths = [];
  const server = http.createServer((request, response) => {
    paths.push(request.url);
    const name = path.join(folder, path.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname)));
    const file = fs.statSync(name, { throwIfNoEntry: false })?.isDirectory() ? path.join(name, 'index.html') : name;
    if (!fs.existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': types[path.extname(file)] ?? 'application/octet-stream', ...(isIsolated ? isolation : {}) });
    return fs.createReadStream(file).pipe(response);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { address: `http://127.0.0.1:${server.address().port}`, paths, close: () => new Promise((done) => server.close(done)) };
}
