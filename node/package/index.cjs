// SPDX-License-Identifier: Apache-2.0
// The package in Node.
'use strict';
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { fileURLToPath } = require('node:url');
const { Worker } = require('node:worker_threads');
const { Pool } = require('./pool.cjs');
const { makeFunctions, pixelsOf, ZoneplateError } = require('./requests.cjs');

let files; // of the module, which all workers share
function start(listener) {
  files ??= { code: WebAssembly.compile(fs.readFileSync(path.join(__dirname, 'zoneplate.wasm'))), studio: fs.readFileSync(path.join(__dirname, 'studio.env')) };
  let worker, isBusy = true, isStopped = false;
  const started = files.code.then((code) => {
    if (isStopped) return;
    worker = new Worker(path.join(__dirname, 'worker.js'), { workerData: { code, studio: files.studio } });
    worker.on('message', listener.answer);
    worker.on('error', listener.fail);
    worker.on('exit', () => isStopped || listener.fail(new Error('the worker of the renderer has ended')));
    if (!isBusy) worker.unref();
  });
  return {
    post: (message) => started.then(() => worker?.postMessage(message)).catch(listener.fail),
    stop() {
      isStopped = true;
      worker?.terminate();
    },
    hold(busy) { // an idle worker does not keep the process alive
      isBusy = busy;
      if (busy) worker?.ref();
      else worker?.unref();
    },
  };
}

const processors = os.availableParallelism?.() ?? os.cpus().length;
const pool = new Pool(start, Math.min(8, processors));

/// The name of a file as the module sees it: relative to the working directory, or below /zoneplate.host.
function nameOf(file) {
  const name = file instanceof URL ? fileURLToPath(file) : file;
  if (!path.isAbsolute(name)) return name.replaceAll(path.sep, '/');
  return `/zoneplate.host/${path.resolve(name).replaceAll(path.sep, '/').replace(/^\//, '')}`;
}

const isBytes = (value) => value instanceof Uint8Array || value instanceof ArrayBuffer;

function toRequest(model, given) {
  if (isBytes(model)) return { model: 'model', files: { ...given, model } };
  if (typeof model !== 'string' && !(model instanceof URL)) throw new TypeError('model: expected a path, a URL, or the bytes of a file');
  if (given?.[model]) return { model, files: given };
  if (given) throw new TypeError(`files: has no '${model}', the model`);
  return { model: nameOf(model), files: {}, folder: process.cwd() };
}

function toImage(image) {
  if (isBytes(image)) return { bytes: image };
  if (typeof image === 'string' || image instanceof URL) return { path: nameOf(image), folder: process.cwd() };
  const pixels = pixelsOf(image);
  if (pixels) return { pixels };
  if (isBytes(image?.data)) return { bytes: image.data };
  throw new TypeError('image: expected a path, a URL, the bytes of a file, or { width, height, data }');
}

const { render, renderFiles, info, compare, list } = makeFunctions((request) => pool.ask(request), toRequest, toImage);

/// Sets the greatest number of workers, each of which answers one request at a time.
function setWorkers(count) {
  if (!Number.isInteger(count) || count < 1) throw new RangeError('workers: expected a whole number of 1 or more');
  pool.most = count;
}

module.exports = { render, renderFiles, info, compare, list, setWorkers, close: () => pool.stop(), ZoneplateError };
