// One instance of the renderer, in a worker of its own. Requests { id, name, args } get replies { id, result } or { id, error }.
// The address of the worker states how many threads render: more than one need a page that is cross-origin isolated.
import { decodeImage } from './images.js';

const threads = Number(new URL(import.meta.url).searchParams.get('threads'));

const studio = fetch(new URL('./studio.env', import.meta.url)).then((answer) => (answer.ok ? answer.arrayBuffer() : Promise.reject(new Error('studio.env is missing'))));
const ready = import(`./${threads > 1 ? 'threads/' : ''}zoneplate_playground.js`).then(({ default: makeModule }) => makeModule({ threads }))
  .then((module) => ({ module, session: module.ccall('make_session', 'number', [], []) }));
/// The bytes of a module's memory; with threads it may have grown in any of them, and only `wasmMemory` is of its size.
const memoryOf = ({ wasmMemory, HEAPU8 }) => new Uint8Array((wasmMemory ?? HEAPU8).buffer);
let models = 0;
const isLit = setStudio();
isLit.catch(() => {}); // the first scene reports it

/// Writes the prepared light of scenes without lights where the session looks for it.
async function setStudio() {
  const { key } = await call('name_studio'), { FS } = (await ready).module;
  FS.mkdir('/cache');
  FS.writeFile(`/cache/${key}`, new Uint8Array(await studio));
}

/// The font of drawings, where the program looks for it.
let font;
async function setFont() {
  const answer = await fetch(new URL('./DejaVuSans.ttf', import.meta.url));
  if (!answer.ok) throw new Error('DejaVuSans.ttf is missing');
  const { FS } = (await ready).module, folder = '/usr/share/fonts/truetype/dejavu';
  FS.mkdirTree(folder);
  FS.writeFile(`${folder}/DejaVuSans.ttf`, new Uint8Array(await answer.arrayBuffer()));
}

/// The weights of networks and tables, where weights.cpp reads them.
let weights;
async function setWeights() {
  const names = await call('list_weights');
  const files = await Promise.all(names.map(async (name) => {
    const answer = await fetch(new URL(`./weights/${name}.bin`, import.meta.url));
    if (!answer.ok) throw new Error(`weights/${name}.bin is missing`);
    return new Uint8Array(await answer.arrayBuffer());
  }));
  const { FS } = (await ready).module;
  FS.mkdirTree('/weights');
  files.forEach((bytes, i) => FS.writeFile(`/weights/${names[i]}.bin`, bytes));
}
/// Fetches them if a text names a method that needs them.
const weightsFor = (text) => (text.includes('learned') ? (weights ??= setWeights()) : undefined);

/// Calls a function of session.cpp that returns JSON.
async function call(name, types = [], args = []) {
  const { module, session } = await ready;
  const result = JSON.parse(module.ccall(name, 'string', ['number', ...types], [session, ...args]));
  if (result.error) throw new Error(result.error);
  return result;
}

/// The same for what reads images: readers run without interruption, and browsers decode images only between. What a reader met
/// is decoded, and the call repeated.
async function callReading(name, types, args) {
  const { module } = await ready;
  module.images ??= [];
  for (;;) {
    module.missing = [];
    const answer = await call(name, types, args).catch((error) => ({ error }));
    if (!module.missing.length && answer.error) throw answer.error;
    if (!module.missing.length) return answer;
    module.images.push(...await Promise.all(module.missing.map(decodeImage)));
  }
}

/// Writes files, { path, bytes }, into the working directory, where models and options find them.
async function write(files) {
  const { FS } = (await ready).module;
  for (const { path, bytes } of files) {
    if (path.includes('/')) FS.mkdirTree(`./${path.slice(0, path.lastIndexOf('/'))}`);
    FS.writeFile(path, bytes);
  }
}

const requests = {
  catalogue: () => call('list_catalogue'),
  async builtin(text) {
    await isLit;
    return call('open_model', ['string'], [text]);
  },
  /// The first of the files is the model.
  async model(files) {
    await isLit;
    const { module } = await ready, { FS } = module, folder = `/models/${++models}`;
    FS.mkdirTree(folder);
    FS.chdir(folder);
    module.images = [];
    await write(files);
    return callReading('open_model', ['string'], [files[0].path]);
  },
  /// Further files, which options name.
  async files(files) {
    await write(files);
    return {};
  },
  /// The light of an image, filtered for all scenes: { key, data } for the request `environment`.
  async prepare(file) {
    await write([file]);
    const { key, at, size } = await call('prepare_environment', ['string'], [file.path]);
    return { key, data: memoryOf((await ready).module).slice(at, at + size) };
  },
  /// Takes a light that another renderer has prepared.
  async environment({ key, data }) {
    const { FS } = (await ready).module;
    await isLit;
    FS.writeFile(`/cache/${key}`, data);
    return {};
  },
  /// A lesson as a scene of a viewer, and its images.
  async figure(text, panel) {
    await (font ??= setFont());
    await weightsFor(text);
    const { scene, images } = await call('draw_figure', ['string', 'number'], [text, panel]), memory = memoryOf((await ready).module);
    return { scene, images: images.map(({ at, width, height }) => ({ width, height, data: memory.slice(at, at + 4 * width * height) })) };
  },
  samples: (x, y) => call('samples_of', ['number', 'number'], [x, y]),
  /// `options` are those of the command, [NAME, VALUE], or [NAME, ''] of a switch; `frame` is -1 for a still image.
  async render({ options, frame = -1 }) {
    const text = options.map(([name, value]) => (value === '' ? name : `${name}=${value}`)).join('\n');
    await weightsFor(text);
    const counts = await callReading('render_frame', ['string', 'number'], [text, frame]);
    const { module, session } = await ready;
    const at = module.ccall('pixels_of', 'number', ['number'], [session]);
    return { ...counts, data: memoryOf(module).slice(at, at + 4 * counts.width * counts.height) };
  },
};

onmessage = async ({ data: { id, name, args } }) => {
  try {
    const result = await requests[name](...args);
    postMessage({ id, result }, [result, ...(result.images ?? [])].flatMap(({ data }) => (data ? [data.buffer] : [])));
  } catch (error) {
    postMessage({ id, error: error.message ?? String(error) });
  }
};
