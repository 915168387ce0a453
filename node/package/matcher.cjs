// SPDX-License-Identifier: Apache-2.0
// A matcher for the `expect.extend` of vitest, jest and Playwright.
'use strict';
const fs = require('node:fs');
const path = require('node:path');
const { fileURLToPath } = require('node:url');
const { compare, render } = require('./index.cjs');
const { saveFile } = require('./save.cjs');

const images = ['.png', '.apng', '.jpg', '.jpeg', '.webp', '.gif', '.bmp', '.tga', '.hdr', '.pfm'];
const isImage = (name) => images.includes(path.extname(name instanceof URL ? name.pathname : name).toLowerCase());
const isName = (value) => typeof value === 'string' || value instanceof URL;
const options = ['jnd', 'pixels', 'tolerance', 'antialiasing', 'ignore', 'render'];

/// The bytes of an image file, for a golden image.
async function fileOf(image) {
  if (isName(image)) return fs.readFileSync(image);
  if (image instanceof Uint8Array || image instanceof ArrayBuffer) return new Uint8Array(image);
  if (image.output === 'png') return image.data;
  throw new TypeError('toMatchRender: only the bytes of a file can become a new image: render with output png');
}

/// Whether an image, or the rendering of a model, is that of `expected`, the path of an image file or an image, within
/// { jnd } just noticeable differences, or but for { pixels } pixels, which differ by more than { tolerance } 8-bit codes
/// and, with { antialiasing: true }, not only by the coverage of an edge.
async function toMatchRender(received, expected, { jnd, pixels, tolerance = 0, antialiasing = false, ignore = [], render: rendering, ...unknown } = {}) {
  for (const name of Object.keys(unknown)) throw new TypeError(`toMatchRender: no option '${name}'; there are ${options.join(', ')}`);
  if (jnd !== undefined && pixels !== undefined) throw new TypeError('toMatchRender: jnd and pixels exclude each other');
  const made = isName(received) && !isImage(received) ? await render(received, { ...rendering, output: 'png' }) : received;

  const golden = isName(expected) ? (expected instanceof URL ? fileURLToPath(expected) : path.resolve(expected)) : undefined;
  const isUpdated = process.env.ZONEPLATE_UPDATE === '1' || this?.snapshotState?._updateSnapshot === 'all';
  const save = async (name) => {
    fs.mkdirSync(path.dirname(name), { recursive: true });
    saveFile(name, await fileOf(made));
  };
  if (golden && !fs.existsSync(golden) && !(isUpdated && !this?.isNot)) // a failure of `not`, too
    return { pass: Boolean(this?.isNot), message: () => `${expected}: no such image; ZONEPLATE_UPDATE=1, or --update, makes it` };
  if (golden && isUpdated && !this?.isNot) {
    await save(golden);
    return { pass: true, message: () => `${expected}: was written` };
  }

  const metric = jnd === undefined ? `pixels:tolerance=${tolerance},antialiasing=${antialiasing ? 1 : 0}` : 'cvvdp';
  let found, text;
  try {
    const { metrics } = await compare(expected, made, { metrics: [metric], ignore });
    if (jnd === undefined) {
      found = metrics.pixels.figures.pixels <= (pixels ?? 0);
      text = `${metrics.pixels.figures.pixels} pixels differ by more than ${tolerance} codes${antialiasing ? ', beside those of edges' : ''}; ${pixels ?? 0} may`;
    } else {
      const difference = 10 - metrics.cvvdp.value; // JOD count down from 10 by just noticeable differences
      found = difference <= jnd;
      text = `the difference is ${difference.toFixed(3)} JND; ${jnd} are allowed`;
    }
  } catch (error) {
    if (error.code !== 'input') throw error;
    found = false, text = error.message; // an image of another size, or a damaged one
  }
  if (golden && !found && !this?.isNot) {
    const { dir, name } = path.parse(golden), actual = path.join(dir, `${name}.actual.png`);
    if (!isName(made) && (made.output ?? 'png') === 'png') {
      await save(actual);
      text += `; the image is ${actual}`;
    }
  }
  return { pass: found, message: () => `${golden ? `${expected}: ` : ''}${text}` };
}

module.exports = { toMatchRender };
