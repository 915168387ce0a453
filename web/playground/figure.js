// A lesson of `zoneplate demo`: its parameters, and the images, plots and tables that the program's code makes for them.
import { defaultOf, makeField, readSpec, writeSpec } from './chooser.js';
import { makeCurves } from './curves.js';
import { Renderer } from './renderer.js';
import { element, list } from './report/dom.js';
import { addPicture } from './report/picture.js';
import { Stage } from './report/stage.js';
import { makeTable } from './report/table.js';
import { defaultPanel, demoCommandOf, panels } from './state.js';

const patience = 2; // seconds of work that a change waits for; longer work is given up

export class FigurePanel {
  /// `rows` are the lessons of the catalogue; `go` displays a state, `set` changes it; `ended` gets the error, or ''.
  constructor(rows, go, set, ended) {
    Object.assign(this, { rows, go, set, ended, seconds: new Map(), pictures: [] });
    const button = (text, by) => element('button', { type: 'button', onclick: () => this.turn(by) }, text);
    this.title = element('h2'), this.summary = element('p', { class: 'lesson-text' }), this.knobs = element('div', { class: 'knobs' });
    this.panelList = list('Size of an image', panels.map((size) => `${size} pixels`), (i) => set({ panel: panels[i] === defaultPanel ? '' : panels[i] }));
    this.place = element('span', { class: 'label' });
    this.bar = element('progress', { 'aria-label': 'Drawing' }), this.status = element('p', { role: 'status' });
    this.reset = element('button', { type: 'button', onclick: () => set({ demo: this.row.name }) }, 'Reset');
    this.stage = new Stage([], 'Error map', () => {});
    this.plots = element('div', { class: 'plots' }), this.tables = element('div', { class: 'details' }), this.text = element('p', { class: 'lesson-text figure-text' });
    this.command = element('code');
    this.node = element('section', { class: 'figure', 'aria-label': 'Lesson of the program', hidden: true },
      element('div', { class: 'card lesson' }, this.title, this.summary, this.knobs,
        element('div', { class: 'row' }, button('‹ Back', -1), button('Next ›', 1), this.place, this.panelList, this.reset,
          element('button', { type: 'button', onclick: () => go({}) }, 'Close'), element('span', { class: 'work' }, this.bar, this.status))),
      this.stage.node, this.plots, this.tables, this.text,
      element('section', { class: 'command', 'aria-label': 'Command' }, element('span', { class: 'label' }, 'The same lesson by the program:'), this.command));
  }

  turn(by) {
    const { rows } = this;
    this.go({ demo: rows[(rows.indexOf(this.row) + by + rows.length) % rows.length].name });
  }

  /// Displays the lesson of the state, or nothing.
  show(state) {
    const { name, given } = readSpec(state.demo), row = this.rows.find((r) => r.name === name);
    this.node.hidden = !state.demo;
    if (!state.demo) {
      this.stage.sequence.stop();
      return this.stop();
    }
    this.panelList.selectedIndex = panels.indexOf(state.panel || defaultPanel);
    this.command.textContent = demoCommandOf(state);
    this.showKnobs(row, given);
    this.wanted = [state.demo, Number(state.panel || defaultPanel)];
    return this.draw();
  }

  showKnobs(row, given) {
    if (!row || this.row !== row || !this.knobs.contains(document.activeElement)) {
      this.knobs.replaceChildren(...(row?.params ?? []).map((param) => makeField(param, 'figure', given.get(param.name) ?? defaultOf(param), (value) => this.change(param, value))));
      this.summary.textContent = row?.summary ?? '';
      this.place.textContent = row ? `${this.rows.indexOf(row) + 1} of ${this.rows.length}` : '';
    }
    [...this.knobs.children].forEach((field, i) => field.classList.toggle('changed', given.has(row.params[i].name)));
    this.reset.hidden = !given.size;
    this.row = row, this.given = given;
  }

  /// A value that is the default is left out.
  change(param, value) {
    const given = new Map(this.given);
    if (value === defaultOf(param) || value === '') given.delete(param.name);
    else given.set(param.name, value);
    this.set({ demo: writeSpec({ name: this.row.name, given }) });
  }

  // ---- the work

  /// Draws what is wanted; of several changes during the work, the last one.
  async draw() {
    const isShown = () => JSON.stringify(this.wanted) === this.done;
    if (this.isBusy && (this.began === JSON.stringify(this.wanted) || performance.now() - this.start < 1000 * patience)) return;
    if (this.isBusy) this.stop();
    if (isShown()) return this.ended('');
    const renderer = this.renderer ??= new Renderer(), text = this.began = JSON.stringify(this.wanted);
    this.isBusy = true;
    this.watch();
    let error = '';
    try {
      const result = await renderer.ask('figure', ...this.wanted);
      if (renderer !== this.renderer) return;
      this.display(result);
      this.done = text;
    } catch (failure) {
      if (renderer !== this.renderer) return;
      error = failure.message, this.done = undefined;
    }
    this.isBusy = false;
    this.watch();
    if (this.wanted && text !== JSON.stringify(this.wanted)) return this.draw();
    this.ended(error);
  }

  /// Gives up the work that is being done.
  stop() {
    this.wanted = undefined;
    if (!this.isBusy) return;
    this.renderer.worker.terminate();
    this.renderer = undefined, this.isBusy = false;
    this.watch();
  }

  /// Displays the progress: by the time of the lesson before, if there is one.
  watch() {
    const key = this.row?.name;
    clearInterval(this.ticking);
    this.bar.hidden = !this.isBusy;
    if (!this.isBusy) {
      const seconds = (performance.now() - this.start) / 1000;
      this.seconds.set(key, seconds);
      this.status.textContent = `Drawn in ${seconds.toFixed(1)} s.`;
      return;
    }
    this.start = performance.now();
    this.status.textContent = 'Being drawn …';
    const tick = () => {
      const seconds = (performance.now() - this.start) / 1000, known = this.seconds.get(key);
      if (known) this.bar.value = Math.min(0.97, seconds / known);
      else this.bar.removeAttribute('value');
    };
    tick();
    this.ticking = setInterval(tick, 100);
  }

  display({ scene, images }) {
    const old = this.pictures, { stage } = this;
    this.pictures = images.map((image, i) => addPicture(image, old[i]));
    for (const image of scene.images) image.frames = image.frames.map((i) => this.pictures[i]);
    const shape = JSON.stringify([scene.name, images.map(({ width, height }) => [width, height]), scene.images.map(({ frames }) => frames.length)]);
    this.title.textContent = scene.title, this.text.textContent = scene.text;
    stage.node.hidden = !scene.images.length;
    // Of the same lesson, the view and the frame stay.
    if (shape === this.shape) stage.scene = scene, stage.listImages(), stage.rebuild();
    else if (scene.images.length) stage.layout = 'grid', stage.show(scene);
    this.shape = shape;
    this.plots.replaceChildren(...(scene.plots ?? []).map(makeCurves));
    this.tables.replaceChildren(...scene.tables.map((table) => makeTable(table, () => {})));
  }
}
