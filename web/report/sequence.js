// Playing and stepping through the frames of a sequence.
import { element, list, nameOf } from './dom.js';

const rates = [1, 2, 5, 10, 12, 24, 25, 30, 50, 60];

export class Sequence {
  /// `show(frame)` displays a frame; `isReady()` is true if the displayed frame is complete, so that the next may follow.
  constructor(show, isReady) {
    Object.assign(this, { showImages: show, isReady });
    const button = (text, label, action) => element('button', { type: 'button', title: label, 'aria-label': nameOf(text, label), onclick: action }, text);
    this.playButton = button('Play', 'Play (key P)', () => this.toggle());
    this.bar = element('input', { type: 'range', min: 0, value: 0, 'aria-label': 'Frame', oninput: () => this.showImages(Number(this.bar.value)) });
    this.text = element('output');
    this.rateList = list('Frames per second', [], (i) => (this.rate = this.rates[i]));
    this.node = element('div', { class: 'sequence', role: 'group', 'aria-label': 'Frames' }, this.playButton,
      button('‹', 'Previous frame (key ,)', () => this.step(-1)), button('›', 'Next frame (key .)', () => this.step(1)), this.bar, this.text, this.rateList);
  }

  show(count, rate) {
    this.stop();
    Object.assign(this, { count, rate, frame: 0 });
    this.rates = [...new Set([...rates, rate])].sort((a, b) => a - b);
    this.rateList.replaceChildren(...this.rates.map((r) => element('option', { selected: r === rate }, `${+r.toFixed(2)} fps`)));
    this.node.hidden = count < 2;
    this.bar.max = count - 1;
  }

  showFrame(frame) {
    this.frame = frame;
    this.bar.value = frame;
    this.text.textContent = `frame ${frame + 1} of ${this.count}`;
  }

  step(by) {
    if (this.count < 2) return;
    this.stop();
    this.showImages((this.frame + by + this.count) % this.count);
  }

  toggle() {
    if (this.count < 2) return;
    if (this.isPlaying) return this.stop();
    this.isPlaying = true;
    this.playButton.textContent = 'Pause';
    let last = performance.now();
    const next = (now) => {
      if (!this.isPlaying) return;
      if (now - last >= 1000 / this.rate - 2 && this.isReady()) {
        last = now;
        this.showImages((this.frame + 1) % this.count);
      }
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  stop() {
    this.isPlaying = false;
    this.playButton.textContent = 'Play';
  }
}
