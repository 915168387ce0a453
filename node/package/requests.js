// SPDX-License-Identifier: Apache-2.0
// The functions of the package, which are the same in Node and in browsers. No imports, as pool.js.

const statuses = ['', 'failed', 'usage', 'input', 'output', 'memory'];

/// An error of the renderer: `code` is 'usage', 'input', 'output', 'memory' or 'failed'.
export class ZoneplateError extends Error {
  constructor(message, code) {
    super(message);
    this.name = 'ZoneplateError', this.code = code;
  }
}

/// `ask` sends a request to a worker; `toRequest(model, files)` describes a model by { model, files, folder }, and
/// `toImage(image)` an image.
export function makeFunctions(ask, toRequest, toImage) {
  async function send(request) {
    const { error, status, isSpent, ...reply } = await ask(request);
    if (error !== undefined) throw new ZoneplateError(error, statuses[status]);
    return reply;
  }

  const loadOptions = ['format', 'variant', 'scene', 'animation', 'time', 'maxMemory', 'maxSeconds'];
  /// The options of loading, and the others.
  const split = (options) => {
    const load = {}, others = {};
    for (const [name, value] of Object.entries(options)) (loadOptions.includes(name) ? load : others)[name] = value;
    return { load, others };
  };

  /// Matrices have four rows, or are flat.
  const toCamera = (camera) => (camera?.matrix ? { ...camera, matrix: [...camera.matrix].flatMap((row) => (typeof row === 'number' ? row : [...row])) } : camera);

  async function render(model, options = {}) {
    const { load, others: { view, camera, files, ...own } } = split(options);
    const reply = await send({ verb: 'render', load, view, camera: toCamera(camera), options: own, ...await toRequest(model, files) });
    const { width, height, warnings, data: { data }, arrays } = reply;
    return { width, height, output: own.output ?? 'png', data, arrays, warnings };
  }

  async function info(model, options = {}) {
    const { load, others: { files, ...unknown } } = split(options);
    for (const name of Object.keys(unknown)) throw new ZoneplateError(`info: no option '${name}'; there are ${loadOptions.join(', ')}, files`, 'usage');
    const { contents, text } = await send({ verb: 'info', load, ...await toRequest(model, files) });
    return Object.defineProperty(contents, 'text', { value: text }); // not a part of JSON
  }

  async function compare(reference, test, { metrics = [], ignore = [], ...unknown } = {}) {
    for (const name of Object.keys(unknown)) throw new ZoneplateError(`compare: no option '${name}'; there are metrics, ignore`, 'usage');
    const request = { verb: 'compare', metrics, ignore, files: {}, pixels: {} };
    for (const [name, image] of [['reference', reference], ['test', test]]) {
      const { path, bytes, pixels, folder } = await toImage(image);
      if (folder !== undefined) request.folder = folder;
      if (pixels) request.pixels[name] = pixels;
      else if (bytes) request.files[name] = bytes;
      if (!pixels) request[name] = { path: path ?? `/zoneplate.files/${name}` };
    }
    const { map, ...reply } = await send(request);
    for (const metric of Object.values(reply.metrics)) metric.value ??= metric.better === 'higher' ? Infinity : NaN; // JSON has neither
    return map ? { ...reply, map: map.data } : reply;
  }

  const list = () => send({ verb: 'list', files: {} });
  return { render, info, compare, list };
}

/// The pixels of an image { width, height, data }, or nothing.
export function pixelsOf(image) {
  const { width, height, output = 'pixels', data } = image ?? {};
  const type = { Uint8Array: 'uint8', Uint8ClampedArray: 'uint8', Buffer: 'uint8', Uint16Array: 'uint16', Float32Array: 'float32' }[data?.constructor.name];
  const channels = data?.length / (width * height);
  return output === 'pixels' && type && [1, 3, 4].includes(channels) ? { data, type, shape: [height, width, channels] } : undefined;
}
