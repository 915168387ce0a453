// The values of the inspected pixel in the displayed images.
import { element } from './dom.js';
import { pixelOf } from './light.js';
import { loadPicture, pictureNow } from './picture.js';

const linearText = (v) => (v === 0 ? '0' : Math.abs(v) >= 1e-4 && Math.abs(v) < 1e5 ? String(+v.toPrecision(6)) : v.toExponential(4));
const codeText = (picture, code) => (picture.values === 'codes' && picture.depth === 16 ? (255 * code).toFixed(2) : String(Math.floor(255 * code + 0.5)));

/// Three short texts for a pixel that is enlarged, and its luminance.
export function shortValues(picture, x, y) {
  const { codes, linear } = pixelOf(picture, x, y);
  return {
    values: picture.values === 'halves' ? linear.map((v) => String(+v.toPrecision(3))) : codes.map((code) => codeText(picture, code)),
    light: 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2],
  };
}

export class Inspector {
  constructor() {
    this.place = element('caption', {});
    this.body = element('tbody');
    const heads = ['image', 'sRGB red', 'green', 'blue', 'linear red', 'green', 'blue', 'alpha', 'Δ sRGB', 'error'];
    this.node = element('div', { class: 'inspector', tabindex: 0, role: 'region', 'aria-label': 'Values of the pixel' }, element('table', {}, this.place,
      element('thead', {}, element('tr', {}, heads.map((head) => element('th', { scope: 'col' }, head)))), this.body));
  }

  /// A row for each displayed image and the reference.
  rows(stage) {
    const { pixel, scene, reference } = stage;
    if (!pixel) return [];
    const at = (index) => {
      const picture = pictureNow(index);
      return picture && pixel.width === picture.width && pixel.height === picture.height ? { picture, ...pixelOf(picture, pixel.x, pixel.y) } : null;
    };
    const against = at(stage.frameOf(reference));
    return [...new Set([reference, ...stage.shownImages()])].map((i) => {
      const image = scene.images[i], own = at(stage.frameOf(i));
      if (!own) return null;
      const map = image.errors?.[Math.min(stage.frame, image.errors.length - 1)] ?? -1, errors = pictureNow(map);
      if (map >= 0 && !errors) loadPicture(map).then(() => stage.refresh());
      const difference = against && i !== reference ? Math.max(...own.codes.map((code, c) => Math.abs(code - against.codes[c]))) : null;
      return { name: image.name, own, difference, error: errors ? pixelOf(errors, pixel.x, pixel.y).codes[0] : null };
    }).filter(Boolean);
  }

  show(stage) {
    const { pixel } = stage;
    this.place.textContent = pixel ? `Pixel ${pixel.x}, ${pixel.y}` : 'Move over an image to inspect a pixel, or focus the panes and press shift and an arrow key.';
    this.node.classList.toggle('empty', !pixel);
    this.body.replaceChildren(...this.rows(stage).map(({ name, own, difference, error }) => {
      const { picture, codes, linear, alpha } = own;
      const color = `rgb(${codes.map((code) => Math.floor(255 * code + 0.5)).join(' ')})`;
      const cells = [...codes.map((code) => codeText(picture, code)), ...linear.map(linearText), linearText(alpha),
        difference === null ? '' : codeText(picture, difference), error === null ? '' : error.toFixed(3)];
      return element('tr', {}, element('th', { scope: 'row' }, element('span', { class: 'swatch', style: `background: ${color}` }), name,
        picture.isRounded ? element('small', {}, ' rounded to half floats') : null), cells.map((cell) => element('td', {}, cell)));
    }));
  }

  words(stage) {
    const { pixel } = stage;
    return `Pixel ${pixel.x}, ${pixel.y}. ` + this.rows(stage).map(({ name, own }) => `${name}: ${own.codes.map((code) => codeText(own.picture, code)).join(' ')}`).join('; ');
  }
}
