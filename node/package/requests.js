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

/// A row of the table of options from the name of an option: 'shadows', 'hdri-file' of hdriFile.
export const rowName = (name) => name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
export const optionName = (row) => row.replace(/-([a-z])/g, (_, letter) => letter.toUpperCase());

const isList = (value) => Array.isArray(value) || ArrayBuffer.isView(value);
const textOf = (value) => (isList(value) ? [...value].map(textOf).join(',') : String(value));
/// Rows of which each use adds a value.
export const repeated = ['section', 'allow-path'];

/// Options that are shorter than a row, or of another type.
const shorter = {
  aovs: (names) => ['aov', names.length ? names : null],
  transparent: (is) => ['no-background', is],
  cullBackFaces: (are) => ['no-cull', !are],
  shadowGround: (is) => ['ground', is ? 'shadow' : null],
  ambientOcclusion: (rays) => ['ambient-occlusion', typeof rays !== 'number' ? rays : rays > 0 ? `rays:samples=${rays}` : null],
  environment: (light) => ['environment', isList(light) ? `linear:${textOf(light)}` : light],
};
const ofView = { index: 'camera-index', position: 'camera-position', focalPoint: 'camera-focal-point', viewUp: 'camera-view-up', verticalFov: 'camera-view-angle',
  azimuth: 'camera-azimuth-angle', elevation: 'camera-elevation-angle', orthographic: 'camera-orthographic' };

/// The rows that options set, [NAME, TEXT], or [NAME, null] for a switch. `quality` is first: it sets several, which others
/// change.
export function rowsOf({ view, ...options }) {
  const rows = Object.entries(options).map(([name, value]) => (value === undefined || value === null ? [name, null] : shorter[name]?.(value) ?? [rowName(name), value]));
  for (const [name, value] of Object.entries(view ?? {}))
    rows.push([ofView[name] ?? (() => { throw new ZoneplateError(`view: no option '${name}'; there are ${Object.keys(ofView).join(', ')}`, 'usage'); })(), value]);
  return rows.filter(([, value]) => value !== undefined && value !== null && value !== false)
    .flatMap(([name, value]) => (repeated.includes(name) && isList(value) && !(typeof value[0] === 'number') ? value.map((one) => [name, one]) : [[name, value]]))
    .map(([name, value]) => [name, value === true ? null : textOf(value)])
    .sort(([a], [b]) => (b === 'quality') - (a === 'quality'));
}

/// `ask` sends a request to a worker; `toRequest(model, files)` describes a model by { model, files, folder }, and
/// `toImage(image)` an image.
export function makeFunctions(ask, toRequest, toImage) {
  async function send(request) {
    const { error, status, isSpent, ...reply } = await ask(request);
    if (error !== undefined) throw new ZoneplateError(error, statuses[status]);
    return reply;
  }

  /// Matrices have four rows, or are flat.
  const toCamera = (camera) => (camera?.matrix ? { ...camera, matrix: [...camera.matrix].flatMap((row) => (typeof row === 'number' ? row : [...row])) } : camera);

  async function render(model, { files, camera, dtype, output, ...options } = {}) {
    const request = { verb: 'render', rows: rowsOf(options), form: { dtype, output }, ...await toRequest(model, files) };
    if (camera !== undefined && camera !== null) request.camera = toCamera(camera);
    const { width, height, warnings, data: { data }, arrays } = await send(request);
    return { width, height, output: output ?? 'png', data, arrays, warnings };
  }

  /// The files that the command writes for this name of an output, by their names.
  async function renderFiles(model, name, { files, ...options } = {}) {
    if (typeof name !== 'string' || /^$|[/\\]/.test(name)) throw new ZoneplateError(`${name}: expected the name of a file, without a folder`, 'usage');
    const { files: made, warnings } = await send({ verb: 'save', output: `/zoneplate.out/${name}`, rows: rowsOf(options), ...await toRequest(model, files) });
    return { files: Object.fromEntries(Object.entries(made).map(([file, { data }]) => [file, data])), warnings };
  }

  async function info(model, { files, ...options } = {}) {
    const { contents, text } = await send({ verb: 'info', rows: rowsOf(options), ...await toRequest(model, files) });
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
  return { render, renderFiles, info, compare, list };
}

/// The pixels of an image { width, height, data }, or nothing.
export function pixelsOf(image) {
  const { width, height, output = 'pixels', data } = image ?? {};
  const type = { Uint8Array: 'uint8', Uint8ClampedArray: 'uint8', Buffer: 'uint8', Uint16Array: 'uint16', Float32Array: 'float32' }[data?.constructor.name];
  const channels = data?.length / (width * height);
  return output === 'pixels' && type && [1, 3, 4].includes(channels) ? { data, type, shape: [height, width, channels] } : undefined;
}
