// The pictures inside the page, decoded when they are first displayed, and the layers that are drawn from them.
import { bytesOfText } from './bytes.js';
import { decodePng } from './png.js';
import { oneAsHalf, screenCode, screenCodes, valueOfHalf } from './light.js';

/// A map that holds at most `limit` units of its values; the entries that were used least recently are removed first.
class Cache {
  constructor(limit) { this.limit = limit, this.held = 0, this.entries = new Map(); }
  get(key) {
    const entry = this.entries.get(key);
    if (entry) this.entries.delete(key), this.entries.set(key, entry);
    return entry?.value;
  }
  remove(key) {
    this.held -= this.entries.get(key)?.size ?? 0;
    this.entries.delete(key);
  }
  set(key, value, size) {
    this.entries.set(key, { value, size });
    this.held += size;
    for (const [oldest, entry] of this.entries) {
      if (this.held <= this.limit || oldest === key) break;
      this.entries.delete(oldest);
      this.held -= entry.size;
    }
    return value;
  }
}

const stored = [...document.querySelectorAll('script.picture')];
const decoded = new Cache(768 << 20), layers = new Cache(512 << 20);
const loading = new Map();

/// Decodes a picture; null for the index -1.
export function loadPicture(index) {
  if (index === undefined || index < 0) return Promise.resolve(null);
  const known = decoded.get(index);
  if (known) return Promise.resolve(known);
  if (!loading.has(index)) {
    const { textContent, dataset } = stored[index];
    loading.set(index, decodePng(bytesOfText(textContent), dataset.values === 'halves' ? oneAsHalf : undefined).then((png) => {
      loading.delete(index);
      const picture = { ...png, index, values: dataset.values, isRounded: 'rounded' in dataset };
      return decoded.set(index, picture, picture.data.byteLength);
    }));
  }
  return loading.get(index);
}

/// Adds a picture of 8-bit codes that is not in the page, in place of the one with index `old`; returns its index.
let added = 0;
export function addPicture({ width, height, data }, old = -1) {
  const index = stored.length + added++;
  decoded.remove(old);
  decoded.set(index, { width, height, data, depth: 8, values: 'codes', index }, data.byteLength);
  return index;
}

/// The size of a picture; of one in the page, from its header alone.
export function sizeOf(index) {
  const known = pictureNow(index);
  if (known) return { width: known.width, height: known.height };
  const bytes = bytesOfText(stored[index].textContent.slice(0, 48)), view = new DataView(bytes.buffer);
  return { width: view.getUint32(16), height: view.getUint32(20) };
}

/// The picture if it is decoded already.
export const pictureNow = (index) => (index === undefined || index < 0 ? null : decoded.get(index) ?? null);

/// The codes of the screen at an exposure of `stops`, four channels per pixel.
function codesOf(picture, stops) {
  const { data, values, depth } = picture, table = screenCodes(picture, stops);
  const isLight = values === 'halves', opaque = isLight ? oneAsHalf : 2 ** depth - 1;
  const out = new Uint8ClampedArray(data.length);
  for (let i = 0; i < data.length; i += 4) {
    const alpha = data[i + 3];
    for (let c = i; c < i + 3; ++c) out[c] = table[data[c]];
    out[i + 3] = 255;
    if (alpha === opaque) continue;
    const share = isLight ? valueOfHalf(alpha) : alpha / opaque;
    out[i + 3] = 255 * share;
    if (!isLight || !(share > 0)) continue;
    // Premultiplied light: the colour of the surface is light / alpha.
    for (let c = i; c < i + 3; ++c) out[c] = screenCode(valueOfHalf(data[c]) / share, stops);
  }
  return out;
}

function paintErrors(picture, gain, colors) {
  const out = new Uint8ClampedArray(picture.data.length);
  for (let i = 0; i < out.length; i += 4) {
    const color = 3 * Math.min(255, Math.round(picture.data[i] * gain));
    out[i] = colors[color], out[i + 1] = colors[color + 1], out[i + 2] = colors[color + 2], out[i + 3] = 255;
  }
  return out;
}

/// The absolute difference of two arrays of codes on black, multiplied by `gain`.
function differenceOf(a, b, gain) {
  const out = new Uint8ClampedArray(a.length);
  for (let i = 0; i < out.length; i += 4) {
    for (let c = i; c < i + 3; ++c) out[c] = gain * Math.abs(a[c] * a[i + 3] - b[c] * b[i + 3]) / 255;
    out[i + 3] = 255;
  }
  return out;
}

/// Paints a layer from decoded pictures; null while one of them is not decoded.
function paint({ what, picture, other, errors, row, frames, stops, gain }, colors) {
  const own = pictureNow(what === 'errors' ? errors : picture);
  if (what === 'slice') return paintSlice(frames, row, stops);
  if (!own) return null;
  const codes = what === 'errors' ? paintErrors(own, gain, colors) : codesOf(own, stops);
  if (what !== 'difference') return { codes, width: own.width, height: own.height };
  const reference = pictureNow(other);
  if (!reference || reference.width !== own.width || reference.height !== own.height) return null;
  return { codes: differenceOf(codes, codesOf(reference, stops), gain), width: own.width, height: own.height };
}

/// One row of every frame, from the first frame at the top to the last at the bottom, as high as a frame.
function paintSlice(frames, row, stops) {
  const pictures = frames.map(pictureNow);
  if (pictures.some((picture) => !picture)) return null;
  const { width, height, values, depth } = pictures[0], out = new Uint8ClampedArray(4 * width * height);
  const rows = pictures.map(({ data }) => codesOf({ data: data.subarray(4 * width * row, 4 * width * (row + 1)), values, depth }, stops));
  for (let y = 0; y < height; ++y) out.set(rows[Math.floor(y * rows.length / height)], 4 * width * y);
  return { codes: out, width, height };
}

/// The layer as a canvas. While its pictures are being decoded: null, and `whenReady` is called after that.
export function layerNow(layer, colors, whenReady) {
  const key = JSON.stringify(layer), known = layers.get(key);
  if (known) return known;
  const needed = layer.what === 'slice' ? layer.frames : layer.what === 'errors' ? [layer.errors]
    : layer.what === 'difference' ? [layer.picture, layer.other] : [layer.picture];
  if (needed.some((index) => index === undefined || index < 0)) return null;
  const painted = paint(layer, colors);
  if (!painted) {
    if (needed.some((index) => !pictureNow(index))) Promise.all(needed.map(loadPicture)).then(whenReady);
    return null;
  }
  const canvas = document.createElement('canvas');
  canvas.width = painted.width, canvas.height = painted.height;
  canvas.isOpaque = painted.codes.every((code, i) => i % 4 < 3 || code === 255);
  canvas.getContext('2d').putImageData(new ImageData(painted.codes, painted.width, painted.height), 0, 0);
  return layers.set(key, canvas, painted.codes.length);
}
