// The images of a scene: panes with one transform, their layouts and layers, and the pixel that is inspected.
import { choice, element, list, nameOf } from './dom.js';
import { Inspector } from './inspector.js';
import { Pane } from './pane.js';
import { loadPicture, pictureNow, sizeOf } from './picture.js';
import { Pointer } from './pointer.js';
import { Sequence } from './sequence.js';
import { View, zooms } from './view.js';

const gains = [1, 2, 4, 8, 16, 32, 64];
const percent = (zoom) => (zoom >= 1 ? `${+zoom.toFixed(2)}×` : `${Math.round(100 * zoom)} %`);

export class Stage {
  constructor(colors, errorName, onChange) {
    Object.assign(this, { colors, errorName, onChange });
    this.view = new View();
    this.layout = 'grid', this.what = 'picture', this.stops = 0, this.split = 0.5;
    this.gains = { difference: 4, errors: 1 };
    this.panes = [];
    this.inspector = new Inspector();
    this.sequence = new Sequence((frame) => this.set({ frame }), () => this.framesAreReady());
    this.node = element('section', { class: 'stage', 'aria-label': 'Images' }, this.makeTools(), this.sequence.node, this.makeRoom(),
      this.strip = element('div', { class: 'strip', role: 'group', 'aria-label': 'Choose images' }), this.inspector.node,
      this.status = element('p', { class: 'unseen', role: 'status' }));
    this.pointer = new Pointer(this);
    new ResizeObserver(() => this.arrange()).observe(this.room);
    addEventListener('resize', () => this.arrange());
  }

  makeTools() {
    const button = (text, label, action, attributes = {}) =>
      element('button', { type: 'button', title: label, 'aria-label': nameOf(text, label), onclick: action, ...attributes }, text);
    this.layoutChoice = choice('Layout', [['grid', 'Side by side', 'G'], ['single', 'One', 'F'], ['slider', 'Slider', 'S']],
      (layout) => this.set({ layout }));
    this.whatChoice = choice('Display', [['picture', 'Image', 'I'], ['difference', 'Difference', 'D'],
      ['errors', this.errorName, 'E'], ['slice', 'x–t slice', 'T']], (what) => this.set({ what }));
    this.gainList = list('Gain', gains.map((gain) => `× ${gain}`), (i) => this.setGain(gains[i]));
    this.zoomList = list('Zoom', ['Fit', ...zooms.map(percent)], (i) => (i ? this.zoomTo(zooms[i - 1]) : this.fit()));
    this.zoomText = this.zoomList.options[0];
    this.exposure = element('input', { type: 'range', min: -10, max: 10, step: 0.25, value: 0, 'aria-label': 'Exposure in stops',
      oninput: () => this.set({ stops: Number(this.exposure.value) }) });
    this.exposureText = button('0', 'Reset the exposure', () => this.set({ stops: 0 }), { class: 'value' });
    this.regionButton = button('Worst region', 'Enlarge the region of greatest error (key W)', () => this.showRegion());
    this.referenceList = list('Reference', [], (reference) => this.set({ reference }));
    const hold = (isHeld) => () => this.set({ isHeld });
    this.holdButton = button('Hold', 'While held: the reference in all panes (key R or space)', () => {}, {
      onpointerdown: hold(true), onpointerup: hold(false), onpointerleave: hold(false), onblur: hold(false),
      onkeydown: (e) => (e.key === ' ' || e.key === 'Enter') && this.set({ isHeld: true }), onkeyup: hold(false) });
    const group = (label, ...parts) => element('span', { class: 'group' }, element('span', { class: 'label' }, label), ...parts);
    this.rowInput = element('input', { type: 'number', min: 0, 'aria-label': 'Row of the slice',
      oninput: () => this.set({ row: Math.min(this.size.height - 1, Math.max(0, Math.round(this.rowInput.value))) }) });
    this.rowGroup = group('Row', this.rowInput);
    this.gainGroup = group('Gain', this.gainList);
    this.referenceGroup = group('Against', this.referenceList, this.holdButton);
    return element('div', { class: 'tools', role: 'toolbar', 'aria-label': 'View' }, this.layoutChoice.node, this.whatChoice.node, this.gainGroup, this.rowGroup,
      this.referenceGroup, element('span', { class: 'group' }, button('−', 'Smaller (key -)', () => this.zoomBy(-1)), this.zoomList,
        button('+', 'Larger (key +)', () => this.zoomBy(1)), this.regionButton),
      group('Exposure', this.exposure, this.exposureText));
  }

  makeRoom() {
    this.room = element('div', { class: 'room', tabindex: 0, 'aria-label': 'Panes. Arrow keys move the images, with shift the inspected pixel.' });
    this.handle = element('div', { class: 'handle', role: 'slider', tabindex: 0, 'aria-label': 'Slider between reference and image',
      'aria-valuemin': 0, 'aria-valuemax': 100, onkeydown: (event) => this.keyOfHandle(event) });
    return this.room;
  }

  // ---- the scene

  show(scene) {
    this.scene = scene;
    const { images } = scene;
    this.marked = images.findIndex((image) => image.is_reference);
    const reference = Math.max(0, this.marked), hasFrames = images.some((image) => image.frames.length > 1);
    Object.assign(this, { reference, shown: new Set(scene.chosen ?? images.map((_, i) => i).slice(0, 6)), frame: scene.frame ?? 0, pixel: null, row: null, isHeld: false });
    this.current = images.findIndex((_, i) => i !== reference && this.shown.has(i));
    if (this.current < 0) this.current = 0;
    this.hasErrors = images.some((image) => image.errors?.some((index) => index >= 0));
    this.hasFrames = hasFrames;
    if ((this.what === 'errors' && !this.hasErrors) || this.what === 'slice') this.what = 'picture';
    if (images.length === 1 && this.layout === 'slider') this.layout = 'grid';
    this.listImages();
    this.sequence.show(Math.max(...images.map((image) => image.frames.length)), scene.fps ?? 24);
    // Fits are those of the largest width and height.
    this.sizes = images.map((image) => image.frames.find((index) => index >= 0)).map((index) => (index === undefined ? { width: 1, height: 1 } : sizeOf(index)));
    this.size = { width: Math.max(...this.sizes.map((size) => size.width)), height: Math.max(...this.sizes.map((size) => size.height)) };
    this.row = this.size.height >> 1;
    this.view.isFitted = true;
    this.panes = [];
    this.rebuild();
    // So that the first alternation does not wait for a decoder.
    images.forEach((_, i) => i < 16 && loadPicture(this.frameOf(i)));
  }

  listImages() {
    const { images } = this.scene;
    this.referenceList.replaceChildren(...images.map((image) => element('option', {}, image.name)));
    this.strip.replaceChildren(...images.map((image, i) => element('button', { type: 'button', onclick: () => this.choose(i) },
      element('kbd', {}, this.keyOf(i)), image.name)));
    this.strip.hidden = images.length < 2;
  }

  /// Replaces an image by one of the same size; the view stays.
  replace(i, image) {
    const { images } = this.scene, isRenamed = images[i].name !== image.name;
    images[i] = image;
    if (isRenamed) this.listImages();
    this.refresh();
  }

  /// The image of a key: 0 is the scene's reference, 1 to 9 are the others.
  imageOf(key) {
    if (key === '0') return this.marked;
    const place = key - 1;
    return this.marked >= 0 && place >= this.marked ? place + 1 : place;
  }
  keyOf(i) { return [...'0123456789'].find((key) => this.imageOf(key) === i) ?? ''; }
  frameOf(i) {
    const { frames } = this.scene.images[i];
    return frames[Math.min(this.frame, frames.length - 1)];
  }

  choose(i) {
    if (this.layout !== 'grid') return this.set({ current: i });
    const shown = new Set(this.shown);
    if (!shown.delete(i)) shown.add(i);
    if (shown.size) this.set({ shown, current: shown.has(i) ? i : this.current });
  }

  /// Displays an image and a frame, as tables and plots request it.
  go({ image, frame }) {
    if (image !== undefined) this.set({ current: image, shown: new Set([...this.shown, image]) });
    if (frame !== undefined) this.set({ frame });
  }

  set(changes) {
    const { layout } = this;
    if (changes.what === 'slice' && this.pixel) this.row = this.pixel.y;
    Object.assign(this, changes);
    if (this.layout === layout && String(this.shownImages()) === String(this.panes.map((pane) => pane.i))) this.refresh();
    else this.rebuild();
  }
  setGain(gain) { this.gains[this.what] = gain; this.refresh(); }

  // ---- the view

  get pane() { return this.panes[0].size; }
  fit() { this.view.fit(this.size, this.pane); this.refresh(); }
  zoomTo(zoom, at = { x: this.pane.width / 2, y: this.pane.height / 2 }) {
    this.view.zoomTo(zoom, at, this.size, this.pane);
    this.refresh();
  }
  zoomBy(direction, at) {
    const zoom = this.view.next(direction);
    const isSmallest = zoom <= View.fitting(this.size, this.pane) && direction < 0;
    if (isSmallest) this.fit();
    else this.zoomTo(zoom, at);
    return !isSmallest;
  }
  /// Moves the images; while they are visible as a whole, `turn` gets the movement, if the page has set it.
  moveBy(dx, dy) {
    if (this.turn && this.view.isFitted) return this.turn(dx, dy);
    this.view.move(dx, dy, this.size, this.pane);
    return this.refresh();
  }
  showRegion() {
    const { x, y, size } = this.scene.region;
    const side = Math.min(this.pane.width, this.pane.height);
    this.view.zoom = zooms.findLast((zoom) => zoom * size <= side) ?? 1;
    this.view.middle = { x: (x + size / 2) / this.size.width, y: (y + size / 2) / this.size.height };
    this.view.isFitted = false;
    this.view.clamp(this.size, this.pane);
    this.refresh();
  }

  // ---- panes

  /// The images of the panes; in the slider's only pane, the reference is left of the current image.
  shownImages() {
    return this.layout === 'grid' ? this.scene.images.map((_, i) => i).filter((i) => this.shown.has(i)) : [this.current];
  }

  rebuild() {
    this.panes = this.shownImages().map((i) => new Pane(this, i));
    this.room.replaceChildren(...this.panes.map((pane) => pane.node));
    if (this.layout === 'slider') this.panes[0].canvas.after(this.handle);
    this.arrange();
  }

  /// The number of images in a row of a lesson, whose rows of images and enlarged regions differ in size; 0: no such rows.
  rowLength() {
    const isNew = ({ width, height }, i) => i > 0 && (width !== this.sizes[i - 1].width || height !== this.sizes[i - 1].height);
    const first = this.sizes.findIndex(isNew), { length } = this.sizes;
    const isRegular = first > 1 && length % first === 0 && this.sizes.every((size, i) => isNew(size, i) === (i > 0 && i % first === 0));
    return isRegular && this.panes.length === length ? first : 0;
  }

  /// Gives the panes their sizes: as large as the images of all panes can be without scrolling, but legible.
  arrange() {
    if (!this.panes.length) return;
    const gap = 8, head = 30, room = this.room.clientWidth;
    if (room <= 0) return;
    const tall = Math.max(260, Math.round(innerHeight * 0.66));
    const { width, height } = this.size, count = this.panes.length;
    let best = { side: 0 };
    for (let columns = 1; columns <= count; ++columns) {
      const rows = Math.ceil(count / columns), paneWidth = Math.floor((room - (columns - 1) * gap) / columns);
      const side = Math.min(paneWidth / width, (tall / rows - head) / height);
      if (side > best.side) best = { side, columns, paneWidth, paneHeight: Math.floor(tall / rows - head) };
    }
    const least = Math.min(room, 300);
    if (best.side * width < least * 0.8 && count > 1) {
      const columns = Math.min(count, Math.max(1, Math.floor((room + gap) / (least + gap))));
      best = { columns, paneWidth: Math.floor((room - (columns - 1) * gap) / columns), paneHeight: Infinity };
    }
    const row = this.rowLength(), narrowest = 200;
    if (row && room >= row * narrowest) best = { columns: row, paneWidth: Math.floor((room - (row - 1) * gap) / row), paneHeight: Infinity };
    // Long names have two lines in every pane, so that the images stay where they are while another name is displayed.
    const letter = 8, hasLongNames = count > 1 && this.scene.images.some(({ name }) => letter * name.length + head > best.paneWidth);
    this.room.classList.toggle('tall', hasLongNames);
    best.paneHeight = Math.max(120, Math.min(best.paneHeight, Math.ceil(best.paneWidth * height / width)));
    const fitting = View.fitting(this.size, { width: best.paneWidth, height: best.paneHeight });
    if (fitting >= 1) best.paneHeight = Math.max(120, fitting * height);
    this.room.style.gridTemplateColumns = `repeat(${best.columns}, ${best.paneWidth}px)`;
    for (const pane of this.panes) pane.resize(best.paneWidth, best.paneHeight);
    if (this.view.isFitted) this.view.fit(this.size, this.pane);
    else this.view.clamp(this.size, this.pane);
    this.refresh();
  }

  /// What a pane displays: the reference while it is held; the reference itself never as a difference from itself.
  layerOf(i) {
    const image = this.scene.images[i], isReference = i === this.reference;
    const what = this.what === 'slice' || (!isReference && !this.isHeld) ? this.what : 'picture';
    const errors = image.errors?.[Math.min(this.frame, image.errors.length - 1)] ?? -1;
    const layer = { what, picture: this.frameOf(i), stops: this.stops };
    if (what === 'difference') Object.assign(layer, { other: this.frameOf(this.reference), gain: this.gains.difference });
    if (what === 'errors') return { what, errors, gain: this.gains.errors };
    if (what === 'slice') return { what, frames: image.frames, row: Math.min(this.row, this.sizes[i].height - 1), stops: this.stops };
    return layer;
  }

  framesAreReady() {
    const needed = this.shownImages().flatMap((i) => [this.layerOf(i).picture, this.layerOf(i).other, this.layerOf(i).errors]);
    return needed.every((index) => index === undefined || index < 0 || pictureNow(index));
  }

  /// Decodes the frames before and after the displayed one, so that a step does not wait for them.
  loadNeighbours() {
    for (const i of this.hasFrames ? this.shownImages() : []) {
      const { frames } = this.scene.images[i], { length } = frames;
      for (const step of [1, length - 1]) loadPicture(frames[(this.frame + step) % length]);
    }
  }

  refresh() {
    if (this.isScheduled || !this.scene) return;
    this.isScheduled = true;
    requestAnimationFrame(() => {
      this.isScheduled = false;
      if (!this.panes.length) return;
      for (const pane of this.panes) pane.draw();
      this.showTools();
      this.inspector.show(this);
      this.loadNeighbours();
      this.onChange();
    });
  }

  /// What a pane displays of an image, in words.
  describe(i) {
    const { what, gain } = this.layerOf(i), reference = this.scene.images[this.reference].name;
    const words = { picture: 'image', difference: `difference from ${reference} × ${gain}`, errors: `${this.errorName} map × ${gain}`,
      slice: `row ${this.row} of all frames` };
    return `${words[what]}, ${percent(this.view.zoom)}`;
  }

  showTools() {
    const { images } = this.scene, isAlone = images.length < 2;
    this.layoutChoice.show(this.layout, isAlone ? ['slider', 'single'] : []);
    this.whatChoice.show(this.what, [...(this.hasErrors ? [] : ['errors']), ...(this.hasFrames ? [] : ['slice']), ...(isAlone ? ['difference'] : [])]);
    this.rowGroup.hidden = this.what !== 'slice';
    if (document.activeElement !== this.rowInput) this.rowInput.value = this.row;
    // The gain keeps its place, so that the panes stay where they are.
    this.gainGroup.hidden = isAlone && !this.hasErrors;
    this.gainList.disabled = !(this.what in this.gains);
    this.gainList.selectedIndex = gains.indexOf(this.gains[this.what] ?? 1);
    this.referenceGroup.hidden = isAlone;
    this.referenceList.selectedIndex = this.reference;
    this.regionButton.hidden = !this.scene.region;
    this.zoomText.textContent = `Fit (${percent(View.fitting(this.size, this.pane))})`;
    const place = zooms.findIndex((zoom) => Math.abs(zoom - this.view.zoom) < 1e-6);
    this.zoomList.selectedIndex = this.view.isFitted ? 0 : place + 1;
    this.exposure.value = this.stops;
    this.exposureText.textContent = `${this.stops > 0 ? '+' : ''}${this.stops} EV`.replace('-', '−');
    this.sequence.showFrame(this.frame);
    const shown = this.shownImages();
    [...this.strip.children].forEach((button, i) => button.setAttribute('aria-pressed', shown.includes(i)));
    if (!this.sequence.isPlaying) this.announce(shown.map((i) => `${images[this.isHeld ? this.reference : i].name}: ${this.describe(i)}`).join('; '));
  }

  announce(text) {
    clearTimeout(this.announcing);
    this.announcing = setTimeout(() => { if (this.status.textContent !== text) this.status.textContent = text; }, 400);
  }

  // ---- keys

  placeHandle(edge) {
    this.handle.style.left = `${edge}px`;
    this.handle.setAttribute('aria-valuenow', Math.round(100 * this.split));
  }

  keyOfHandle(event) {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    this.set({ split: Math.min(1, Math.max(0, this.split + step)) });
  }

  movePixel(dx, dy) {
    const { width, height } = this.sizes[this.current];
    const from = this.pixel ?? { x: Math.floor(this.view.middle.x * width), y: Math.floor(this.view.middle.y * height) };
    const pixel = this.pixel ? { x: Math.min(width - 1, Math.max(0, from.x + dx)), y: Math.min(height - 1, Math.max(0, from.y + dy)) } : from;
    this.set({ pixel: { ...pixel, width, height } });
    this.announce(this.inspector.words(this));
    // The view follows the pixel.
    const { x, y } = this.view.origin({ width, height }, this.pane), zoom = this.view.zoom;
    const beyond = (at, room) => (at < 0 ? -at : at + zoom > room ? room - at - zoom : 0);
    const mx = beyond(x + pixel.x * zoom, this.pane.width), my = beyond(y + pixel.y * zoom, this.pane.height);
    if (mx || my) this.moveBy(mx, my);
  }

  /// Handles a key of the page; returns false if the viewer does not use it.
  key(event) {
    if (!this.panes.length) return false;
    const { key, shiftKey } = event, isDown = event.type === 'keydown';
    const onButton = event.target.closest?.('button, summary, a');
    if (key === 'r' || key === 'R' || (key === ' ' && !onButton)) {
      if (isDown !== Boolean(this.isHeld)) this.set({ isHeld: isDown });
      return true;
    }
    if (!isDown) return false;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    if (arrows[key]) {
      if (!this.room.contains(document.activeElement)) return false;
      const [dx, dy] = arrows[key];
      if (shiftKey) this.movePixel(dx, dy);
      else this.moveBy(-dx * this.pane.width / 8, -dy * this.pane.height / 8);
      return true;
    }
    if (/^[0-9]$/.test(key)) {
      const i = this.imageOf(key);
      if (!this.scene.images[i]) return false;
      this.set({ current: i, layout: this.layout === 'slider' ? 'slider' : 'single' });
      return true;
    }
    const isAlone = this.scene.images.length < 2;
    const actions = {
      g: () => this.set({ layout: 'grid' }),
      f: () => !isAlone && this.set({ layout: 'single' }),
      s: () => !isAlone && this.set({ layout: 'slider' }),
      i: () => this.set({ what: 'picture' }),
      d: () => !isAlone && this.set({ what: 'difference' }),
      e: () => this.hasErrors && this.set({ what: 'errors' }),
      t: () => this.hasFrames && this.set({ what: 'slice' }),
      w: () => this.scene.region && this.showRegion(),
      z: () => this.fit(),
      '+': () => this.zoomBy(1), '=': () => this.zoomBy(1), '-': () => this.zoomBy(-1),
      'x': () => this.zoomTo(1),
      '[': () => this.set({ stops: Math.max(-10, this.stops - 0.5) }),
      ']': () => this.set({ stops: Math.min(10, this.stops + 0.5) }),
      p: () => this.sequence.toggle(),
      ',': () => this.sequence.step(-1), '.': () => this.sequence.step(1),
    };
    const action = actions[key.toLowerCase()];
    if (action) action();
    return Boolean(action);
  }
}
