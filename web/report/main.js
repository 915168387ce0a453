// The page: header, overview, the images of a scene, and its tables and plot.
import { element, list } from './dom.js';
import { makePlot, usablePoints } from './plot.js';
import { Stage } from './stage.js';
import { makeTable } from './table.js';

const data = document.getElementById('content'), content = JSON.parse(data.textContent);
const scenes = content.scenes ?? [];
const colors = Uint8Array.from(data.dataset.colors.match(/../g) ?? [], (code) => parseInt(code, 16));
const app = document.getElementById('app');
const stage = new Stage(colors, content.error_name ?? 'Error map', markSelection);
let shownScene = -1;

const keys = [
  ['0 – 9', 'display one image: 0 the reference, 1 to 9 the others'], ['R or space, held', 'display the reference'],
  ['G  F  S', 'side by side, one image, slider'], ['I  D  E  T', 'image, difference, error map, x–t slice'],
  ['+  −  Z  X', 'larger, smaller, fit, 1×'], ['W', 'the region of greatest error'], ['[  ]', 'exposure'],
  ['arrows', 'move the images, if the panes have the focus; with shift: the inspected pixel'],
  ['P  ,  .', 'play, previous and next frame'], ['N  B', 'next and previous scene'], ['?', 'this list'],
];
const help = element('dialog', { 'aria-label': 'Keys' }, element('h2', {}, 'Keys'),
  element('dl', {}, keys.map(([key, text]) => [element('dt', {}, key), element('dd', {}, text)])),
  element('p', {}, 'Drag moves all images, the wheel zooms, a double click enlarges 8 times and back.'),
  element('form', { method: 'dialog' }, element('button', {}, 'Close')));

const themes = ['auto', 'light', 'dark'];
const themeButton = element('button', { type: 'button', onclick: () => setTheme(themes[(themes.indexOf(document.documentElement.dataset.theme) + 1) % 3]) });
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  themeButton.textContent = `Theme: ${theme}`;
}
setTheme('auto');

const sceneList = list('Scene', scenes.map((scene) => (scene.failed ? '✗ ' : '') + scene.name), (i) => showScene(i));
const heading = element('h2'), about = element('p', { class: 'about' }), details = element('div', { class: 'details' });
const nav = element('nav', { 'aria-label': 'Scenes', hidden: scenes.length < 2 },
  element('button', { type: 'button', 'aria-label': 'Previous scene', title: 'Previous scene (key B)', onclick: () => turn(-1) }, '‹'), sceneList,
  element('button', { type: 'button', 'aria-label': 'Next scene', title: 'Next scene (key N)', onclick: () => turn(1) }, '›'));

function findings({ tables = [], plot }) {
  const parts = [...tables.map((table) => makeTable(table, go))];
  if (plot && usablePoints(plot).length) parts.push(makePlot(plot, go));
  return parts;
}

function showScene(i) {
  shownScene = i;
  const scene = scenes[i];
  sceneList.selectedIndex = i;
  heading.textContent = scene.title ?? '';
  heading.hidden = !scene.title || scenes.length < 2;
  about.textContent = scene.text ?? '';
  about.hidden = !scene.text;
  details.replaceChildren(...findings(scene));
  stage.node.hidden = !scene.images.length;
  if (scene.images.length) stage.show(scene);
}
function turn(by) { if (scenes.length > 1) showScene((shownScene + by + scenes.length) % scenes.length); }

/// Displays what a row or a point stands for.
function go(target) {
  if (target.scene !== undefined && target.scene !== shownScene) showScene(target.scene);
  stage.go(target);
  stage.node.scrollIntoView({ block: 'nearest', behavior: matchMedia('(prefers-reduced-motion: reduce)').matches ? 'auto' : 'smooth' });
}

/// Marks the rows and points of the displayed image.
function markSelection() {
  for (const node of document.querySelectorAll('[data-target]')) {
    const [scene, image, frame] = JSON.parse(node.dataset.target);
    const isShown = (scene === null || scene === shownScene) && (image === null || image === stage.current) && (frame === null || frame === stage.frame);
    node.classList.toggle('selected', isShown);
  }
}
document.addEventListener('drawn', markSelection, true);

app.append(
  element('header', {}, element('div', {}, element('h1', {}, content.title), content.text ? element('p', {}, content.text) : null),
    element('div', { class: 'corner' }, element('button', { type: 'button', onclick: () => help.showModal() }, 'Keys'), themeButton)),
  ...(content.tables?.length || content.plot ? [element('section', { class: 'overview details', 'aria-label': 'Overview' }, findings(content))] : []),
  ...(scenes.length ? [element('section', { class: 'scene', 'aria-label': 'Scene' }, nav, heading, about, stage.node, details)] : []), help);

for (const type of ['keydown', 'keyup']) {
  document.addEventListener(type, (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || help.open || event.target.closest('select, input')) return;
    if (type === 'keydown' && 'nNbB?'.includes(event.key)) {
      if (event.key === '?') help.showModal();
      else turn(event.key.toLowerCase() === 'n' ? 1 : -1);
      return;
    }
    if (stage.key(event)) event.preventDefault();
  });
}
addEventListener('blur', () => stage.isHeld && stage.set({ isHeld: false }));
if (scenes.length) showScene(Math.max(0, scenes.findIndex((scene) => scene.failed)));
