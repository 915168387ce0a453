// A pane: one image of the scene, drawn with the transform that all panes share.
import { element } from './dom.js';
import { shortValues } from './inspector.js';
import { screenCode } from './light.js';
import { layerNow, pictureNow } from './picture.js';
import { visiblePart } from './view.js';

const markColor = '#ffc400', shadeColor = '#000a';

export class Pane {
  constructor(stage, i) {
    const { text } = stage.scene.images[i];
    Object.assign(this, { stage, i, imageSize: stage.sizes[i], size: { width: 0, height: 0 } });
    this.canvas = element('canvas', { role: 'img' });
    this.note = element('p', { class: 'note' });
    this.name = element('span', { class: 'name' });
    this.facts = element('span', { class: 'facts' });
    this.node = element('figure', {},
      element('figcaption', {}, element('kbd', {}, stage.keyOf(i)), this.name, this.facts),
      element('div', { class: 'pane' }, this.canvas, this.note), text ? element('p', { class: 'words' }, text) : null);
  }

  resize(width, height) {
    this.size = { width, height };
    // Whole pixels of the screen, of which each displays one of the canvas.
    this.canvas.width = Math.floor(width * devicePixelRatio), this.canvas.height = Math.floor(height * devicePixelRatio);
    this.canvas.style.width = `${this.canvas.width / devicePixelRatio}px`, this.canvas.style.height = `${this.canvas.height / devicePixelRatio}px`;
  }

  /// The position of a pointer in the pane, in CSS pixels.
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  draw() {
    const { stage, canvas } = this, { images } = stage.scene, context = canvas.getContext('2d');
    const shown = stage.isHeld ? stage.reference : this.i, isDivided = stage.layout === 'slider' && !stage.isHeld;
    context.clearRect(0, 0, canvas.width, canvas.height);
    const missing = this.drawLayer(context, shown);
    if (isDivided) {
      const edge = Math.round(stage.split * this.size.width);
      context.save();
      context.beginPath();
      context.rect(0, 0, edge * devicePixelRatio, canvas.height);
      context.clip();
      context.clearRect(0, 0, canvas.width, canvas.height);
      this.drawLayer(context, stage.reference);
      context.restore();
      stage.placeHandle(edge);
    }
    if (stage.view.zoom >= 48 && stage.what === 'picture' && !isDivided) this.drawValues(context, shown);
    this.drawMarks(context);
    const name = isDivided ? `${images[stage.reference].name} | ${images[shown].name}` : images[shown].name;
    this.name.textContent = this.name.title = name;
    this.facts.textContent = (isDivided ? [stage.reference, shown] : [this.i]).map((i) => images[i].facts).filter(Boolean).join(' | ');
    this.note.textContent = missing ?? '';
    canvas.setAttribute('aria-label', `${name}: ${stage.describe(shown)}`);
    canvas.style.touchAction = stage.view.isFitted ? 'pan-y' : 'none';
  }

  /// Draws an image; returns why nothing is drawn, or undefined.
  drawLayer(context, i) {
    const { stage } = this, layer = stage.layerOf(i), canvas = layerNow(layer, stage.colors, () => stage.refresh());
    if (!canvas) {
      if (layer.picture < 0) return 'This image is not in the page.';
      if (layer.what === 'errors' && layer.errors < 0) return `There is no ${stage.errorName} map of this image.`;
      const isDecoded = [layer.picture, layer.other].every(pictureNow);
      return layer.what === 'difference' && isDecoded ? 'The image and the reference have different sizes.' : undefined;
    }
    const { left, top, scale, from, to } = visiblePart(stage.view, canvas, this.size, devicePixelRatio);
    const width = to.x - from.x, height = to.y - from.y;
    if (width <= 0 || height <= 0) return undefined;
    const place = [left + from.x * scale, top + from.y * scale, width * scale, height * scale];
    if (!canvas.isOpaque) drawSquares(context, ...place);
    context.imageSmoothingEnabled = scale < 1;
    context.imageSmoothingQuality = 'high';
    context.drawImage(canvas, from.x, from.y, width, height, ...place);
    return undefined;
  }

  /// The inspected pixel; the region of greatest error while the whole image is visible; the frame in a slice.
  drawMarks(context) {
    const { scene, view, pixel, what, frame } = this.stage, ratio = devicePixelRatio;
    const { left, top, scale } = visiblePart(view, this.imageSize, this.size, ratio);
    const outline = (x, y, width, height, color, line) => {
      context.strokeStyle = color, context.lineWidth = line;
      context.strokeRect(left + x * scale - line / 2, top + y * scale - line / 2, width * scale + line, height * scale + line);
    };
    const { region } = scene, frames = scene.images[this.i].frames.length;
    if (region && view.isFitted && what !== 'slice') {
      outline(region.x, region.y, region.size, region.size, shadeColor, 3 * ratio);
      outline(region.x, region.y, region.size, region.size, markColor, ratio);
    }
    if (what === 'slice') {
      if (frames > 1) outline(0, (frame + 0.5) * this.imageSize.height / frames, this.imageSize.width, 0, markColor, ratio);
      return;
    }
    if (!pixel || pixel.width !== this.imageSize.width || pixel.height !== this.imageSize.height || view.zoom < 4) return;
    outline(pixel.x, pixel.y, 1, 1, '#000', 2 * ratio);
    outline(pixel.x, pixel.y, 1, 1, '#fff', ratio);
  }

  /// The values of the visible pixels, inside of them.
  drawValues(context, i) {
    const { stage } = this, picture = pictureNow(stage.frameOf(i));
    if (!picture) return;
    const { left, top, scale, from, to } = visiblePart(stage.view, picture, this.size, devicePixelRatio);
    const line = Math.round(11 * devicePixelRatio);
    context.font = `${line}px system-ui, sans-serif`;
    context.textAlign = 'center', context.textBaseline = 'middle';
    for (let y = from.y; y < to.y; ++y)
      for (let x = from.x; x < to.x; ++x) {
        const { values, light } = shortValues(picture, x, y);
        context.fillStyle = screenCode(light, stage.stops) > 140 ? '#000c' : '#fffc';
        values.forEach((value, n) => context.fillText(value, left + (x + 0.5) * scale, top + (y + 0.5) * scale + (n - 1) * line * 1.25));
      }
  }
}

/// Squares behind an image that is not opaque.
function drawSquares(context, left, top, width, height) {
  const side = Math.round(8 * devicePixelRatio);
  for (let y = 0; y < height; y += side)
    for (let x = 0; x < width; x += side) {
      context.fillStyle = (x + y) / side % 2 ? '#999' : '#bbb';
      context.fillRect(left + x, top + y, Math.min(side, width - x), Math.min(side, height - y));
    }
}
