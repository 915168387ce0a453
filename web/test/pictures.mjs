// Pictures whose values the tests know, written without the program's own encoders.
import fs from 'node:fs';
import zlib from 'node:zlib';
import { bytesOfText } from '../report/bytes.js';
import { decodePng } from '../report/png.js';

function chunk(name, body) {
  const out = Buffer.alloc(12 + body.length);
  out.writeUInt32BE(body.length), out.write(name, 4, 'latin1'), body.copy(out, 8);
  out.writeUInt32BE(crc32(out.subarray(4, 8 + body.length)), 8 + body.length);
  return out;
}

function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = crc >>> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/// Writes a PNG of 8 bits; `color(x, y)` gives red, green and blue.
export function writePng(path, width, height, color) {
  const rows = Buffer.alloc(height * (3 * width + 1));
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) rows.set(color(x, y), y * (3 * width + 1) + 1 + 3 * x);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width), head.writeUInt32BE(height, 4), head.set([8, 2, 0, 0, 0], 8);
  fs.writeFileSync(path, Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', head), chunk('IDAT', zlib.deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]));
}

/// Writes an uncompressed Radiance image; `rgbe(x, y)` gives three mantissas and the exponent.
export function writeHdr(path, width, height, rgbe) {
  const rows = Array.from({ length: height }, (_, y) => Array.from({ length: width }, (__, x) => rgbe(x, y))).flat(2);
  fs.writeFileSync(path, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`), Buffer.from(rows)]));
}

/// Writes an uncompressed OpenEXR file of half floats; `bits(x, y)` gives those of blue, green and red.
export function writeExr(path, width, height, bits) {
  const text = (s) => Buffer.from(s + '\0', 'latin1'), int = (...v) => Buffer.concat(v.map((n) => { const b = Buffer.alloc(4); b.writeInt32LE(n); return b; }));
  const float = (v) => { const b = Buffer.alloc(4); b.writeFloatLE(v); return b; };
  const attribute = (name, type, body) => Buffer.concat([text(name), text(type), int(body.length), body]);
  const channels = Buffer.concat([...['B', 'G', 'R'].map((name) => Buffer.concat([text(name), int(1, 0, 1, 1)])), Buffer.from([0])]);
  const window = int(0, 0, width - 1, height - 1);
  const head = Buffer.concat([int(20000630, 2), attribute('channels', 'chlist', channels), attribute('compression', 'compression', Buffer.from([0])),
    attribute('dataWindow', 'box2i', window), attribute('displayWindow', 'box2i', window), attribute('lineOrder', 'lineOrder', Buffer.from([0])),
    attribute('pixelAspectRatio', 'float', float(1)), attribute('screenWindowCenter', 'v2f', Buffer.concat([float(0), float(0)])),
    attribute('screenWindowWidth', 'float', float(1)), Buffer.from([0])]);
  const lines = Array.from({ length: height }, (_, y) => {
    const line = Buffer.alloc(8 + 6 * width);
    line.writeInt32LE(y), line.writeInt32LE(6 * width, 4);
    for (let x = 0; x < width; ++x) bits(x, y).forEach((value, c) => line.writeUInt16LE(value, 8 + 2 * (c * width + x)));
    return line;
  });
  const table = Buffer.alloc(8 * height);
  lines.forEach((line, y) => table.writeBigUInt64LE(BigInt(head.length + table.length + y * line.length), 8 * y));
  fs.writeFileSync(path, Buffer.concat([head, table, ...lines]));
}

/// The data of a page that the program writes, and its pictures, decoded: { content, pictures }.
export async function readPage(path) {
  const page = fs.readFileSync(path, 'utf8'), packed = /<script type="text\/plain" id="viewer">(.*?)<\/script>/s.exec(page)[1];
  const content = JSON.parse(zlib.inflateSync(bytesOfText(packed)).toString().split('\0')[3]);
  return { content, pictures: await Promise.all(picturesOf(path).map((bytes) => decodePng(bytes))) };
}

/// The files of the pictures in a page.
export function picturesOf(path) {
  const stored = fs.readFileSync(path, 'utf8').matchAll(/<script type="text\/plain" class="picture"[^>]*>(.*?)<\/script>/gs);
  return [...stored].map(([, text]) => bytesOfText(text));
}

export const readPng = (path) => decodePng(new Uint8Array(fs.readFileSync(path)));

/// The colour of a pixel: three codes.
export const colorAt = ({ width, data }, x, y) => [...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)];
