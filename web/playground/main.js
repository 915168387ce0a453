// The page: a scene, two methods, and their images side by side.
import { Chooser } from './chooser.js';
import { mostThreads, Renderer } from './renderer.js';
import { element, list } from './report/dom.js';
import { addPicture, sizeOf } from './report/picture.js';
import { Sequence } from './report/sequence.js';
import { Stage } from './report/stage.js';
import { FigurePanel } from './figure.js';
import { LessonPanel } from './lesson.js';
import { Samples } from './samples.js';
import { OptionPanel } from './options.js';
import { commandOf, defaults, hashOf, optionsOf, readState, sizes } from './state.js';

const app = document.getElementById('app');
const state = readState(location.hash);
const sides = ['a', 'b'].map((key) => ({ key, renderer: new Renderer(), picture: -1, done: null, isBusy: false, ms: 0 }));
const samples = new Samples();
const stage = new Stage([], 'Error map', onStage);
stage.layout = state.layout;
const wait = element('p', { class: 'card wait', role: 'status' }, 'The first images are being rendered.');
stage.node.hidden = samples.node.hidden = true;

// ---- what is displayed

const error = element('p', { class: 'error', role: 'alert', hidden: true });
function fail(text) {
  error.textContent = text;
  error.hidden = !text;
}

let model; // { name, files } of a model that was dropped
let environment = '', lightFile; // the file that lights the scene, if any, and its name
let about, loaded, choosers, sceneChooser, figure;
const sizeNow = () => state.size.split('x').map(Number);
const sizeText = (picture) => { const { width, height } = sizeOf(picture); return `${width}x${height}`; };

/// The work that makes the displayed image of a side.
function jobOf({ key }) {
  return { options: optionsOf(state, about, { method: state[key], look: state[`look${key}`], environment }), frame: state.frame === '' ? -1 : Number(state.frame), name: `${state[key]} ${state[`look${key}`].replaceAll(';', ' ')}`.trim() };
}

/// Renders a side until its image is that of the state.
async function render(side) {
  if (side.isBusy || !about) return;
  side.isBusy = true;
  for (let job = jobOf(side); !state.demo && JSON.stringify(job) !== side.done; job = jobOf(side)) {
    side.done = JSON.stringify(job);
    try {
      const image = await side.renderer.ask('render', job);
      side.ms = image.ms, side.hasHistory = image.has_history, side.error = '';
      side.picture = addPicture(image, side.picture);
      display(side, job.name, image);
    } catch (failure) {
      side.error = failure.message;
    }
  }
  side.isBusy = false;
  if (state.demo) return;
  fail(sides.map((s) => s.error).find(Boolean) ?? '');
  // A side that needs another image may not be busy with it yet.
  const isDone = sides.every((s) => !s.isBusy && JSON.stringify(jobOf(s)) === s.done);
  app.dataset.done = String(isDone);
  showControls();
  if (isDone) inspect();
}

function display(side, name, { width, height }) {
  side.image = { name, frames: [side.picture], facts: `${side.ms.toFixed(1)} ms` };
  if (stage.scene && stage.size.width === width && stage.size.height === height) return stage.replace(sides.indexOf(side), side.image);
  if (sides.some(({ image }) => !image || sizeText(image.frames[0]) !== `${width}x${height}`)) return;
  wait.hidden = true, stage.node.hidden = samples.node.hidden = false;
  stage.show({ images: sides.map(({ image }) => image), chosen: [0, 1] });
  stage.set({ current: 1 });
  restorePixel();
  restoreView();
}

/// Enlarges the images as the state demands.
function restoreView() {
  if (state.view === '') return;
  const [zoom, x, y] = state.view.split(',').map(Number), { width, height } = stage.size;
  stage.view.zoom = zoom, stage.view.isFitted = false;
  stage.view.middle = { x: (x + 0.5) / width, y: (y + 0.5) / height };
  stage.set({});
  stage.arrange();
}

/// Writes the state into the address, at most a few times a second: browsers limit how often that may be.
let writing;
function writeAddress() {
  writing ??= setTimeout(() => {
    writing = undefined;
    history.replaceState(null, '', hashOf(state));
  }, 300);
}

/// Changes the state, and renders what it changes.
function set(changes) {
  Object.assign(state, changes);
  app.dataset.done = 'false';
  writeAddress();
  showMode();
  if (state.demo) return;
  showControls();
  for (const side of sides) render(side);
}

/// Displays a lesson of the program in place of the scene and its methods, or hides it.
function showMode() {
  app.classList.toggle('has-figure', Boolean(state.demo));
  lessonPanel.show(state);
  figure.show(state);
}
function endFigure(text) {
  fail(text);
  app.dataset.done = 'true';
}

async function load(scene) {
  const request = model?.name === scene ? ['model', model.files] : ['builtin', scene];
  try {
    [about] = await Promise.all(sides.map(({ renderer }) => renderer.ask(...request)));
    if (lightFile) await Promise.all(sides.map(({ renderer }) => renderer.ask('files', [lightFile]))); // a model has a folder of its own
    fail('');
  } catch (failure) {
    fail(failure.message);
    return false;
  }
  loaded = scene;
  for (const side of sides) side.done = null;
  sequence.show(about.frames, about.frame_rate);
  return true;
}
async function chooseScene(scene) {
  if (await load(scene)) set({ scene, azimuth: '', elevation: '', angle: '', frame: '', pixel: '' });
}

/// Displays a model: the first of the files that is one.
async function chooseFiles(list) {
  const files = await Promise.all([...list].map(async (file) => ({ path: file.webkitRelativePath || file.name, bytes: new Uint8Array(await file.arrayBuffer()) })));
  const first = files.findIndex(({ path }) => /\.(glb|gltf|vrm|obj|ply|stl)$/i.test(path)), light = files.find(({ path }) => /\.hdr$/i.test(path));
  if (first < 0 && light) return chooseEnvironment(light);
  if (first < 0 && files.every(({ path }) => /\.(png|jpe?g|webp|ktx2|tga|json)$/i.test(path))) return addFiles(files);
  if (first < 0) return fail('None of these files is a model or an environment: the page reads .glb, .gltf, .vrm, .obj, .ply and .stl, with the files that belong to them, and .hdr.');
  const last = model;
  model = { name: files[first].path, files: [files[first], ...files.filter((_, i) => i !== first)] };
  if (await load(model.name)) return set({ scene: model.name, azimuth: '', elevation: '', angle: '', frame: '', pixel: '' });
  model = last;
  return undefined;
}

/// Takes images and other files, which options of rendering name: texture=wood.png.
async function addFiles(files) {
  for (const { renderer } of sides) await renderer.ask('files', files);
  filtering.textContent = `Options of rendering may name ${files.map(({ path }) => path).join(', ')}.`;
  for (const side of sides) side.done = null;
  set({});
}

/// Lights the scene by the image of a file, filtered by a renderer of its own; without one, by the scene's own light.
async function chooseEnvironment(file) {
  app.dataset.done = 'false';
  const renderer = file && new Renderer();
  if (file) filtering.textContent = `The light of ${file.path} is being filtered, which takes up to a minute …`;
  try {
    const light = file && await renderer.ask('prepare', file);
    for (const side of file ? sides : []) await side.renderer.ask('environment', light), await side.renderer.ask('files', [file]);
    environment = file?.path ?? '', lightFile = file;
    set({});
  } catch (failure) {
    fail(failure.message);
  }
  renderer?.worker.terminate();
  filtering.textContent = environment ? `Lit by ${environment}.` : '';
  ownLight.hidden = !environment;
}

// ---- the camera and frames

const sequence = new Sequence((frame) => set({ frame: String(frame) }), () => sides.every((side) => !side.isBusy));
const still = element('button', { type: 'button', title: 'The image of a camera that stands still', onclick: () => { sequence.stop(); set({ frame: '' }); } }, 'Still');
sequence.node.prepend(still);
const lens = {
  azimuth: { text: 'Azimuth', low: -180, high: 180, unit: '°', base: () => about.azimuth },
  elevation: { text: 'Elevation', low: -89, high: 89, unit: '°', base: () => about.elevation },
  angle: { text: 'Angle of view', low: 2, high: 100, unit: '°', base: () => about.view_angle },
};
const round = (value) => String(+value.toFixed(2));
for (const [name, part] of Object.entries(lens)) {
  part.number = element('input', { type: 'number', id: name, min: part.low, max: part.high, step: 'any', onchange: () => set({ [name]: part.number.value }) });
  part.range = element('input', { type: 'range', min: part.low, max: part.high, step: 0.5, 'aria-label': part.text, oninput: () => set({ [name]: part.range.value }) });
  part.node = element('div', { class: 'field' }, element('label', { for: name }, part.text), part.number, part.range);
}
const valueOf = (name) => (state[name] === '' ? lens[name].base() : Number(state[name]));

/// Turns the camera by a movement of the pointer in CSS pixels.
stage.turn = (dx, dy) => {
  const azimuth = (valueOf('azimuth') - 0.4 * dx + 540) % 360 - 180;
  set({ azimuth: round(azimuth), elevation: round(Math.min(89, Math.max(-89, valueOf('elevation') + 0.4 * dy))) });
};

// ---- the pixel

let asked = '';
async function inspect() {
  const [x, y] = state.pixel.split(',').map(Number);
  const question = JSON.stringify([state.pixel, ...sides.map((side) => side.done)]);
  if (question === asked || sides.some((side) => side.isBusy)) return;
  asked = question;
  if (state.pixel === '') return samples.show(null, []);
  try {
    const results = await Promise.all(sides.map(async ({ key, renderer }) => ({ name: stage.scene.images[sides.findIndex((side) => side.key === key)].name, result: await renderer.ask('samples', x, y) })));
    if (results.every(({ result }) => result.pixel)) samples.show({ x, y }, results);
  } catch (failure) {
    fail(failure.message);
  }
}
function restorePixel() {
  if (state.pixel === '') return;
  const [x, y] = state.pixel.split(',').map(Number), [width, height] = sizeNow();
  stage.set({ pixel: { x, y, width, height } });
}
function choosePixel() {
  if (!stage.pixel) return;
  state.pixel = `${stage.pixel.x},${stage.pixel.y}`;
  writeAddress();
  inspect();
}
let pressed;
stage.room.addEventListener('pointerdown', ({ clientX, clientY }) => (pressed = [clientX, clientY]));
stage.room.addEventListener('pointerup', ({ clientX, clientY }) => {
  if (pressed && Math.hypot(clientX - pressed[0], clientY - pressed[1]) < 3) choosePixel();
});
stage.room.addEventListener('keyup', (event) => event.key.startsWith('Arrow') && event.shiftKey && choosePixel());

function onStage() {
  if (stage.layout === state.layout) return;
  state.layout = stage.layout;
  writeAddress();
}

// ---- the page

const lessonPanel = new LessonPanel(() => choosers, (next) => go({ ...defaults, ...next }));

const sizeList = list('Size', sizes.map((size) => size.replace('x', ' × ')), (i) => set({ size: sizes[i], pixel: '' }));
const sceneFacts = element('p'), filtering = element('p', { role: 'status' });
const ownLight = element('button', { type: 'button', hidden: true, onclick: () => chooseEnvironment(null) }, 'The scene’s own light');
const commands = element('code');
function showControls() {
  if (!about || state.demo) return;
  sceneChooser.show(state.scene);
  for (const { key } of sides) choosers[key].show(state[key]), choosers[`look${key}`].show(state[`look${key}`]);
  lessonPanel.show(state);
  sizeList.selectedIndex = sizes.indexOf(state.size);
  for (const [name, part] of Object.entries(lens)) {
    part.range.value = valueOf(name);
    if (document.activeElement !== part.number) part.number.value = round(valueOf(name));
  }
  sequence.showFrame(Number(state.frame));
  if (state.frame === '') sequence.text.textContent = about.moves ? 'still, at 0 s' : 'still';
  still.setAttribute('aria-pressed', state.frame === '');
  const row = sceneChooser.rows.find(({ name }) => name === state.scene.split(':')[0]);
  sceneFacts.textContent = [row?.complaint, `${about.triangles.toLocaleString('en')} triangles.`, ...about.warnings].filter(Boolean).join(' ');
  commands.textContent = sides.map(({ key, hasHistory }) => commandOf(state, about, { method: state[key], look: state[`look${key}`], hasHistory, output: `${key}.png`, environment })).join('\n');
}

const keys = [
  ['drag, arrows', 'turn the camera while the whole image is in view; move the images when they are enlarged'], ['wheel, + −', 'enlarge all images at the pointer, reduce'],
  ['click, shift + arrows', 'choose a pixel and display its samples'], ['1  2', 'display image A or B alone'], ['R or space, held', 'image A in all panes'],
  ['G  F  S', 'side by side, one image, slider'], ['I  D', 'image, difference'], ['P  ,  .', 'play, previous and next frame'], ['Z  X', 'fit, 1×'], ['N  B', 'next and previous sample'], ['?', 'this list'],
];
const help = element('dialog', { 'aria-label': 'Keys' }, element('h2', {}, 'Keys'), element('dl', {}, keys.map(([key, text]) => [element('dt', {}, key), element('dd', {}, text)])),
  element('form', { method: 'dialog', class: 'row' }, element('button', {}, 'Close')));
const themes = ['auto', 'light', 'dark'];
const themeButton = element('button', { type: 'button', onclick: () => setTheme(themes[(themes.indexOf(document.documentElement.dataset.theme) + 1) % 3]) });
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  themeButton.textContent = `Theme: ${theme}`;
}
setTheme('auto');

const files = element('input', { type: 'file', multiple: true, hidden: true, 'aria-label': 'Files of a model, or an environment', accept: '.glb,.gltf,.vrm,.obj,.ply,.stl,.mtl,.bin,.ktx2,.hdr,.tga,.json,image/*',
  onchange: () => chooseFiles(files.files) });
for (const type of ['dragover', 'dragleave', 'drop']) {
  document.addEventListener(type, (event) => {
    event.preventDefault();
    document.body.classList.toggle('dropping', type === 'dragover');
    if (type === 'drop' && event.dataTransfer.files.length) chooseFiles(event.dataTransfer.files);
  });
}

function build(catalogue) {
  const { scenes, methods, upscalers, figures, options } = catalogue;
  figure = new FigurePanel(figures, (next) => go({ ...defaults, ...next }), set, endFigure);
  lessonPanel.listFigures(figures);
  const groups = [['Antialiasing', methods.filter((m) => !m.is_reference)], ['References', methods.filter((m) => m.is_reference)], ['Upscalers', upscalers]];
  choosers = Object.fromEntries(sides.map(({ key }) => [key, new Chooser(key, `Method ${key.toUpperCase()}`, groups, (text) => set({ [key]: text }))]));
  for (const { key } of sides)
    choosers[`look${key}`] = new OptionPanel(`look${key}`, `Rendering of ${key.toUpperCase()}`, options, (text) => set({ [`look${key}`]: text }));
  const failures = scenes.filter((scene) => scene.failure), others = scenes.filter((scene) => !scene.failure);
  sceneChooser = choosers.scene = new Chooser('scene', 'Scene', [['Scenes', others], ['Scenes that show a failure', failures]], chooseScene);
  const card = (title, ...parts) => element('section', { class: 'card', 'aria-label': title.at(-1).textContent ?? title.at(-1) }, element('h2', {}, title), ...parts);
  app.replaceChildren(
    element('header', {}, element('div', {}, element('h1', {}, 'Zoneplate playground'),
      element('p', {}, `The renderer runs in this page, by ${mostThreads === 1 ? 'one thread' : `${mostThreads} threads`} an image. Its images have the same bytes as those of the program.`)),
    element('div', { class: 'corner' }, lessonPanel.list, element('nav', { class: 'link-list', 'aria-label': 'Site' }, element('a', { href: '../index.html' }, 'Documentation'),
      element('a', { href: '../lessons/index.html' }, 'Lessons'), element('a', { href: '../gallery/index.html' }, 'Gallery')),
    element('button', { type: 'button', onclick: () => help.showModal() }, 'Keys'), themeButton)),
    error,
    element('div', { class: 'controls' },
      card(['Scene'], sceneChooser.node, sceneFacts, element('div', { class: 'row' },
        element('button', { type: 'button', title: 'Or drop the files on the page', onclick: () => files.click() }, 'Open a model or .hdr …'), ownLight, files), filtering),
      ...sides.map(({ key }) => card([element('span', { class: 'mark' }, key.toUpperCase()), `Method ${key.toUpperCase()}`], choosers[key].node, choosers[`look${key}`].node)),
      card(['Camera'], element('div', { class: 'field' }, element('label', {}, 'Size'), sizeList), ...Object.values(lens).map((part) => part.node),
        element('div', { class: 'row' }, element('button', { type: 'button', onclick: () => set({ azimuth: '', elevation: '', angle: '' }) }, 'Reset the camera')))),
    figure.node, element('div', { class: 'show' }, lessonPanel.node, wait, sequence.node, stage.node, samples.node,
      element('section', { class: 'command', 'aria-label': 'Commands' }, element('span', { class: 'label' }, 'The same images by the program:'), commands)),
    help);
}

for (const type of ['keydown', 'keyup']) {
  document.addEventListener(type, (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || help.open || event.target.closest?.('select, input')) return;
    const key = event.key.toLowerCase();
    if (type === 'keydown') {
      if (event.key === '?') return help.showModal();
      const own = state.demo ? null : { p: () => sequence.toggle(), ',': () => sequence.step(-1), '.': () => sequence.step(1), n: () => samples.go(1), b: () => samples.go(-1) }[key];
      if (own) return own();
    }
    if ((state.demo ? figure.stage : stage).key(event)) event.preventDefault();
    return undefined;
  });
}
addEventListener('blur', () => stage.isHeld && stage.set({ isHeld: false }));
/// Displays another state as a whole.
async function go(next) {
  sequence.stop();
  Object.assign(state, next);
  if (state.demo) return set({});
  showMode();
  stage.set({ layout: state.layout, pixel: null });
  if (next.scene !== loaded && !await load(next.scene)) return undefined;
  if (stage.scene) stage.fit(), restoreView();
  set({});
  return restorePixel();
}
addEventListener('hashchange', () => go(readState(location.hash)));

try {
  build(await sides[0].renderer.ask('catalogue'));
  if (state.demo) set({});
  else if (await load(state.scene)) set({});
  else wait.hidden = true;
} catch (failure) {
  app.replaceChildren(error);
  fail(failure.message);
}
