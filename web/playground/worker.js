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

/// Gives the session the prepared light of scenes without lights.
async function setStudio() {
  await give('set_studio', new Uint8Array(await studio));
}

/// Calls a function of session.cpp that takes bytes.
async function give(name, bytes) {
  const { module } = await ready, at = module._malloc(bytes.length);
  memoryOf(module).set(bytes, at);
  await call(name, ['number', 'number'], [at, bytes.length]);
  module._free(at);
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

/// Calls a function of session.cpp that returns JSON.
async function call(name, types = [], args = []) {
  const { module, session } = await ready;
  const result = JSON.parse(module.ccall(name, 'string', ['number', ...types], [session, ...args]));
  if (result.error) throw new Error(result.error);
  return result;
}

const requests = {
  catalogue: () => call('list_catalogue'),
  async builtin(text) {
    await isLit;
    return call('set_builtin', ['string'], [text]);
  },
  /// `files` are { path, bytes }; the first is the model.
  async model(files) {
    await isLit;
    const { module } = await ready, { FS } = module, folder = `/models/${++models}`;
    FS.mkdirTree(folder);
    for (const { path, bytes } of files) {
      const place = `${folder}/${path}`;
      FS.mkdirTree(place.slice(0, place.lastIndexOf('/')));
      FS.writeFile(place, bytes);
    }
    FS.chdir(folder);
    // Readers run without interruption, and browsers decode images only between: what a reader met is decoded, and the model read again.
    module.images = [];
    for (;;) {
      module.missing = [];
      const about = await call('set_model', ['string'], [files[0].path]).catch((error) => ({ error }));
      if (!module.missing.length && about.error) throw about.error;
      if (!module.missing.length) return about;
      module.images.push(...await Promise.all(module.missing.map(decodeImage)));
    }
  },
  /// The light of an image, filtered for all scenes: bytes for the request `environment`.
  async prepare({ path, bytes }) {
    const { module } = await ready, place = `/${path.split('/').pop()}`;
    module.FS.writeFile(place, bytes);
    const { at, size } = await call('prepare_environment', ['string'], [place]);
    return { data: memoryOf(module).slice(at, at + size) };
  },
  /// The light of the scenes that are chosen from now on; without bytes they have their own.
  async environment(data) {
    await give('set_environment', data);
    return {};
  },
  /// A lesson as a scene of a viewer, and its images.
  async figure(text, panel) {
    await (font ??= setFont());
    const { scene, images } = await call('draw_figure', ['string', 'number'], [text, panel]), memory = memoryOf((await ready).module);
    return { scene, images: images.map(({ at, width, height }) => ({ width, height, data: memory.slice(at, at + 4 * width * height) })) };
  },
  samples: (x, y) => call('samples_of', ['number', 'number'], [x, y]),
  async render({ width, height, azimuth = NaN, elevation = NaN, viewAngle = NaN, method, look = 'look', frame = -1 }) {
    await call('set_view', Array(5).fill('number'), [width, height, azimuth, elevation, viewAngle]);
    const counts = await call('render_frame', ['string', 'string', 'number'], [method, look, frame]);
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
