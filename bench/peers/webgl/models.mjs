// Draws glTF models by three.js in Chromium, without a GPU, and by Zoneplate, in turns, from the same camera, and prints
// the times of a frame and their ratios. A frame of Zoneplate is what follows the reading of the model and precedes the
// encoding of the image: preparation, geometry, tiles and display.
//
// node models.mjs ZONEPLATE MODULES [--size WxH] [--rounds N] [--frames N] [--pictures FOLDER] MODEL...
//   ZONEPLATE  the program
//   MODULES    a folder that holds node_modules
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { parseArgs } from 'node:util';

import { cell, least, median, processorMs, withPage } from './browser.mjs';

const text = { type: 'string' };
const { values: given, positionals: [program, modules, ...models] } = parseArgs({
  allowPositionals: true, options: { size: text, rounds: text, frames: text, pictures: text } });
const [width, height] = (given.size ?? '1920x1080').split('x').map(Number);
const rounds = Number(given.rounds ?? 3), frames = Number(given.frames ?? 5), pictures = given.pictures;
if (!(width > 0 && height > 0 && rounds > 0 && frames > 0)) throw new Error('a size, rounds or frames that is no number');
if (models.length === 0) throw new Error('no model is given');

const threads = os.availableParallelism();

/// A frame by Zoneplate from that camera, in milliseconds.
function draw(model, camera, samples, threadCount, picture) {
  const printed = execFileSync(program, [model, '-o', picture, '--resolution', `${width}x${height}`, '--json',
    '--aa', `msaa:n=${samples}`, '--threads', String(threadCount), '--camera-position', camera.position.join(),
    '--camera-focal-point', camera.centre.join(), '--camera-view-angle', '30'], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
  const { prepare, geometry, tiles, display } = JSON.parse(printed).stage_ms;
  return prepare + geometry + tiles + display;
}

async function compare(index, { ask, pid, folder }) {
  const model = `/file/${index}/${encodeURIComponent(path.basename(models[index]))}`;
  const name = path.basename(models[index], path.extname(models[index]));
  const camera = JSON.parse(await ask({ model }));
  const all = { theirs: [], ours: [], alone: [] };
  let processor = 0;
  const ours = path.join(pictures ?? folder, `${name}-zoneplate.png`);
  for (let round = 0; round < rounds; ++round) {
    const before = processorMs(pid);
    all.theirs.push(...JSON.parse(await ask({ model, frames })));
    processor += processorMs(pid) - before;
    for (let i = 0; i < frames; ++i) {
      all.ours.push(draw(models[index], camera, camera.samples, threads, ours));
      all.alone.push(draw(models[index], camera, camera.samples, 1, ours));
    }
  }
  if (pictures) fs.writeFileSync(path.join(pictures, `${name}-three.png`), await ask({ model }));
  const theirs = processor / all.theirs.length;
  console.log(name.padEnd(30) + cell(camera.samples, 4) + cell(least(all.theirs), 10) + cell(median(all.theirs), 8) +
    cell(theirs, 8) + '  ' + cell(least(all.ours), 8) + cell(median(all.ours), 8) + cell(median(all.alone), 8) + '  ' +
    cell(least(all.theirs) / least(all.ours), 8) + cell(median(all.theirs) / median(all.ours), 8) +
    cell(theirs / median(all.alone), 8));
}

/// A model's file, or one beside it that it names.
function files(name) {
  const [index, ...rest] = name.split('/');
  return models[index] && path.join(path.dirname(models[index]), path.normalize('/' + rest.join('/')));
}
if (pictures) fs.mkdirSync(pictures, { recursive: true });
await withPage({ script: 'models.js', modules, job: { width, height }, files }, async (page) => {
  console.log(`${page.renderer}\n${width}x${height}, ${rounds} rounds of ${frames} frames, ${threads} threads; milliseconds a frame`);
  console.log(`${''.padEnd(27)}samples   three.js: least, median, processor   Zoneplate: least, median, one thread   ratios`);
  for (const index of models.keys()) await compare(index, page);
});
