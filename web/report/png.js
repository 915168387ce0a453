// A decoder for the PNG files that the program writes: 8 or 16 bits per channel, or a palette of 8 bits; not interlaced.
// The values come from the file, not from a canvas, which may be colour-managed or read back with noise.

const channelsOfType = { 0: 1, 2: 3, 3: 1, 6: 4 };

async function inflate(parts) {
  const stream = new Blob(parts).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function paeth(a, b, c) {
  const p = a + b - c, pa = Math.abs(p - a), pb = Math.abs(p - b), pc = Math.abs(p - c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// Reverses the filters of the rows in place; `step` is the number of bytes of a pixel. The rows keep their first byte.
function unfilter(rows, height, rowBytes, step) {
  const stride = rowBytes + 1;
  for (let y = 0; y < height; ++y) {
    const row = y * stride + 1, kind = rows[row - 1], above = row - stride;
    const left = (i) => (i >= step ? rows[row + i - step] : 0);
    const up = (i) => (y > 0 ? rows[above + i] : 0);
    const corner = (i) => (y > 0 && i >= step ? rows[above + i - step] : 0);
    if (kind === 1) for (let i = step; i < rowBytes; ++i) rows[row + i] += rows[row + i - step];
    else if (kind === 2 && y > 0) for (let i = 0; i < rowBytes; ++i) rows[row + i] += rows[above + i];
    else if (kind === 3) for (let i = 0; i < rowBytes; ++i) rows[row + i] += (left(i) + up(i)) >> 1;
    else if (kind === 4) for (let i = 0; i < rowBytes; ++i) rows[row + i] += paeth(left(i), up(i), corner(i));
  }
}

/// { width, height, depth, data }: depth is 8 or 16, data an array of that size with four channels per pixel. `opaque` is
/// the alpha of a file without alpha; by default the greatest value.
export async function decodePng(bytes, opaque = undefined) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const parts = [];
  let header, palette;
  for (let at = 8; at + 12 <= bytes.length;) {
    const length = view.getUint32(at), name = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    const body = bytes.subarray(at + 8, at + 8 + length);
    if (name === 'IHDR') header = { width: view.getUint32(at + 8), height: view.getUint32(at + 12), depth: body[8], type: body[9] };
    if (name === 'PLTE') palette = body;
    if (name === 'IDAT') parts.push(body);
    if (name === 'IEND') break;
    at += length + 12;
  }
  const { width, height, depth, type } = header;
  const channels = channelsOfType[type], step = channels * depth / 8, rowBytes = width * step;
  const rows = await inflate(parts);
  unfilter(rows, height, rowBytes, step);

  const data = depth === 16 ? new Uint16Array(4 * width * height) : new Uint8Array(4 * width * height);
  opaque ??= 2 ** depth - 1;
  let to = 0;
  for (let y = 0; y < height; ++y) {
    let from = y * (rowBytes + 1) + 1;
    const next = depth === 16 ? () => (from += 2, rows[from - 2] << 8 | rows[from - 1]) : () => rows[from++];
    for (let x = 0; x < width; ++x, to += 4) {
      const first = next();
      if (palette) data.set(palette.subarray(3 * first, 3 * first + 3), to);
      else if (channels === 1) data.fill(first, to, to + 3);
      else data[to] = first, data[to + 1] = next(), data[to + 2] = next();
      data[to + 3] = channels === 4 ? next() : opaque;
    }
  }
  return { width, height, depth, data };
}
