// The samples of one pixel, one after the other, and their weighted mean.
import { drawing, element, nameOf } from './report/dom.js';

const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;
const swatch = (color) => element('span', { class: 'swatch', style: `background: ${css(color)}` });
const colorText = (color) => [swatch(color), color.join(' ')];
const linearText = (values) => values.slice(0, 3).map((v) => String(+v.toPrecision(4))).join(' ');

/// A pixel of 256 units a side with its samples; those after number `step` are faint.
function drawPixel({ samples }, step, label) {
  const lines = Array.from({ length: 15 }, (_, i) => 16 * (i + 1)).flatMap((at) => [
    drawing('line', { x1: at, y1: 0, x2: at, y2: 256 }), drawing('line', { x1: 0, y1: at, x2: 256, y2: at })]);
  const radius = samples.length > 64 ? 5 : samples.length > 16 ? 8 : 12;
  const dots = samples.map(({ x, y, color }, i) => {
    const state = i > step ? 'later' : i === step ? 'current' : '';
    return drawing('g', { class: i > step ? 'later' : '' }, drawing('circle', { cx: x, cy: y, r: radius, fill: css(color), class: state }),
      drawing('circle', { cx: x, cy: y, r: radius + 1.2, class: 'ring' }));
  });
  return drawing('svg', { viewBox: '-14 -14 284 284', role: 'img', 'aria-label': label }, ...lines, drawing('rect', { class: 'frame', width: 256, height: 256 }), ...dots);
}

export class Samples {
  constructor() {
    this.step = Infinity, this.results = [];
    const button = (text, label, by) => element('button', { type: 'button', 'aria-label': nameOf(text, label), title: label, onclick: () => this.go(by) }, text);
    this.text = element('output');
    this.pair = element('div', { class: 'pair' });
    this.hint = element('p', {}, 'Choose a pixel: click on an image, or focus the panes and press shift and an arrow key.');
    this.node = element('section', { class: 'card samples', 'aria-label': 'Samples of one pixel' }, element('h2', {}, 'Samples of one pixel'), this.hint,
      this.bar = element('div', { class: 'bar', hidden: true }, button('First', 'First sample', -Infinity), button('‹', 'Previous sample (key B)', -1),
        button('›', 'Next sample (key N)', 1), button('All', 'All samples', Infinity), this.text), this.pair);
  }

  get most() { return Math.max(1, ...this.results.map(({ result }) => result.samples?.length ?? 1)); }

  go(by) {
    const last = this.most - 1, from = Math.min(this.step, last);
    this.step = by === -Infinity ? 0 : by === Infinity || from + by >= last ? Infinity : Math.max(0, from + by);
    this.draw();
  }

  /// `results` are { name, result } of each image.
  show(pixel, results) {
    Object.assign(this, { pixel, results });
    this.draw();
  }

  draw() {
    const { pixel, results } = this;
    this.hint.hidden = this.bar.hidden = true;
    this[pixel ? 'bar' : 'hint'].hidden = false;
    if (!pixel) return this.pair.replaceChildren();
    const last = this.most - 1, step = Math.min(this.step, last);
    this.text.textContent = `Pixel ${pixel.x}, ${pixel.y}: sample ${step + 1} of ${last + 1}`;
    return this.pair.replaceChildren(...results.map(({ name, result }) => this.describe(name, result, step)));
  }

  describe(name, result, most) {
    const facts = (rows) => element('dl', {}, rows.flatMap(([term, text]) => [element('dt', {}, term), element('dd', {}, text)]));
    const pixel = ['Pixel', colorText(result.pixel)];
    if (!result.samples) return element('figure', {}, element('figcaption', {}, name), element('p', { style: 'grid-column: 1 / -1' }, result.reason), facts([pixel]));
    const { samples } = result, step = Math.min(most, samples.length - 1), { x, y, triangle, weight, linear, color, mean } = samples[step];
    const total = samples.reduce((sum, sample) => sum + sample.weight, 0), isLast = step === samples.length - 1;
    const differs = isLast && mean.some((code, i) => code !== result.pixel[i]);
    return element('figure', {}, element('figcaption', {}, name), drawPixel(result, step, `${name}: positions of ${samples.length} samples`),
      element('div', {}, facts([
        ['Sample', `${step + 1} of ${samples.length}`], ['Position', `${x}/256, ${y}/256`], ['Triangle', triangle === null ? 'none: background' : String(triangle)],
        ['Colour', colorText(color)], ['Linear', linearText(linear)], ['Weight', String(+(weight / total).toPrecision(4))],
        [isLast ? 'Mean of all' : `Mean of ${step + 1}`, colorText(mean)], pixel]),
      differs ? element('p', {}, 'The method continues after the mean: it reads other pixels or frames, or adds samples.') : null));
  }
}
