// Images of models, decoded in a worker.
import { decodePng } from './report/png.js';

const signature = '\x89PNG\r\n\x1a\n';

/// Whether decodePng has the texels of a PNG as they are stored: 8 or 16 bits, not interlaced, no palette or key.
function isPlainPng(bytes) {
  if (![...signature].every((c, i) => c.charCodeAt(0) === bytes[i])) return false;
  const text = String.fromCharCode(...bytes.subarray(0, 4096)), [depth, type, interlaced] = [bytes[24], bytes[25], bytes[28]];
  return depth >= 8 && type !== 3 && !interlaced && !text.includes('tRNS');
}

/// { bytes, width, height, depth, data }: four channels per texel; data is null where the browser does not decode the image.
/// Texels of JPEG and WebP are those of the browser's decoder; where they are transparent, premultiplication rounds them.
export async function decodeImage(bytes) {
  try {
    if (isPlainPng(bytes)) return { bytes, ...await decodePng(bytes) };
    const image = await createImageBitmap(new Blob([bytes]), { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    return { bytes, width: image.width, height: image.height, depth: 8, data: context.getImageData(0, 0, image.width, image.height).data };
  } catch {
    return { bytes, width: 0, height: 0, depth: 8, data: null };
  }
}
