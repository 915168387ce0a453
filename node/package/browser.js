// SPDX-License-Identifier: Apache-2.0
// The package in browsers.
import { Pool } from './pool.js';
import { makeFunctions, pixelsOf, ZoneplateError } from './requests.js';

const bytesAt = async (url) => {
  const answer = await fetch(url).catch((error) => { throw new ZoneplateError(`${url}: ${error.message}`, 'input'); });
  if (!answer.ok) throw new ZoneplateError(`${url}: ${answer.status} ${answer.statusText}`, 'input');
  return answer.arrayBuffer();
};
let files; // of the module, which all workers share
function start(listener) {
  files ??= Promise.all([bytesAt(new URL('./zoneplate.wasm', import.meta.url)).then((bytes) => WebAssembly.compile(bytes)),
    bytesAt(new URL('./studio.env', import.meta.url))]);
  const worker = new Worker(new URL('./browser-worker.js', import.meta.url), { type: 'module' });
  worker.onmessage = ({ data }) => listener.answer(data);
  worker.onerror = (event) => listener.fail(new Error(event.message || 'the worker of the renderer could not be loaded'));
  const started = files.then(([code, studio]) => worker.postMessage({ code, studio: new Uint8Array(studio) }));
  return { post: (message) => started.then(() => worker.postMessage(message)).catch(listener.fail), stop: () => worker.terminate(), hold() {} };
}

const pool = new Pool(start, Math.min(8, navigator.hardwareConcurrency ?? 1));
const isBytes = (value) => value instanceof Uint8Array || value instanceof ArrayBuffer;
/// Names of built-in scenes are words, with parameters: sphere:triangles=1000.
const isUrl = (value) => value instanceof URL || (typeof value === 'string' && !/^[a-z][a-z\d-]*(:[\w-]+=[^/]*)?$/.test(value));
const nameOf = (url) => decodeURIComponent(new URL(url, document.baseURI).pathname.split('/').pop());

async function toRequest(model, given) {
  if (isBytes(model)) return { model: 'model', files: { ...given, model } };
  if (given?.[model] || !isUrl(model)) return { model, files: given ?? {} };
  return { model: nameOf(model), files: { ...given, [nameOf(model)]: await bytesAt(model) } };
}

async function toImage(image) {
  if (isBytes(image)) return { bytes: image };
  if (isUrl(image)) return { bytes: await bytesAt(image) };
  const pixels = pixelsOf(image);
  if (pixels) return { pixels };
  if (isBytes(image?.data)) return { bytes: image.data };
  throw new TypeError('image: expected a URL, the bytes of a file, or { width, height, data }');
}

export const { render, renderFiles, info, compare, list } = makeFunctions((request) => pool.ask(request), toRequest, toImage);
export { ZoneplateError };

/// Sets the greatest number of workers, each of which answers one request at a time.
export function setWorkers(count) {
  if (!Number.isInteger(count) || count < 1) throw new RangeError('workers: expected a whole number of 1 or more');
  pool.most = count;
}
export const close = () => pool.stop();
