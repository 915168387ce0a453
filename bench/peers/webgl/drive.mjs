// Filters the same pictures in Chromium, without a GPU, and by Zoneplate, in turns, and prints times and their ratios.
//
// node drive.mjs PEER_FILTERS MODULES [--size WxH] [--rounds N] [--frames N] [--pictures FOLDER]
//   PEER_FILTERS  the program that filters here (bench/peers/filters.cpp)
//   MODULES       a folder that holds node_modules
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

import { cell, least, median, processorMs, withPage } from './browser.mjs';

const [program, modules, ...rest] = process.argv.slice(2);
const option = (name, otherwise) => (rest.includes('--' + name) ? rest[rest.indexOf('--' + name) + 1] : otherwise);
const [width, height] = option('size', '2048x1024').split('x').map(Number);
const rounds = Number(option('rounds', 3)), frames = Number(option('frames', 5));
const pictures = option('pictures', '');
if (!(width > 0 && height > 0 && rounds > 0 && frames > 0)) throw new Error('bad options: ' + rest.join(' '));

const scenes = ['teapot', 'city'];
/// What stands against what; of the first and the last the pictures are compared too.
const cases = [
  { theirs: 'three r137 FXAA 3.11', ours: 'fxaa' },
  { theirs: 'three FXAAPass', ours: 'fxaa' },
  { theirs: 'postprocessing FXAA', ours: 'fxaa' },
  { theirs: 'three SMAAPass', ours: 'smaa' },
  { theirs: 'postprocessing SMAA high', ours: 'smaa' },
];

const run = (...args) => execFileSync(program, args.map(String), { encoding: 'utf8' });
const codesOf = (folder, scene) => path.join(folder, scene + '.rgba');

async function compare(scene, { theirs, ours }, { folder, ask, pid }) {
  const codes = codesOf(folder, scene);
  const all = { theirs: [], ours: [] }, processor = { theirs: 0, ours: 0 };
  await ask({ scene, filter: theirs, frames: 1 });
  for (let round = 0; round < rounds; ++round) {
    const before = processorMs(pid);
    all.theirs.push(...JSON.parse(await ask({ scene, filter: theirs, frames })));
    processor.theirs += processorMs(pid) - before;
    const result = JSON.parse(run('time', ours, width, height, codes, 4 * frames));
    all.ours.push(...result.ms);
    processor.ours += result.processor_ms;
  }
  const picture = path.join(folder, 'theirs.rgba');
  fs.writeFileSync(picture, await ask({ scene, filter: theirs }));
  const name = pictures && path.join(pictures, `${scene}-${theirs.replaceAll(' ', '-')}`);
  const off = JSON.parse(run('distance', ours, width, height, codes, picture, name));
  const n = all.theirs.length;
  console.log(`${scene.padEnd(8)}${theirs.padEnd(26)}` +
    cell(least(all.theirs), 8) + cell(median(all.theirs), 8) + cell(processor.theirs / n, 9) + '  ' +
    cell(least(all.ours), 8) + cell(median(all.ours), 8) + cell(processor.ours / all.ours.length, 9) + '  ' +
    cell(least(all.theirs) / least(all.ours), 8) + cell(median(all.theirs) / median(all.ours), 8) +
    cell((processor.theirs / n) / (processor.ours / all.ours.length), 8) + '   ' +
    `${off.changed_percent.toFixed(2)} ${off.theirs_percent.toFixed(2)} ${off.differing_percent.toFixed(3)}`);
}

if (pictures) fs.mkdirSync(pictures, { recursive: true });
const files = (name, folder) => codesOf(folder, path.basename(name));
await withPage({ script: 'page.js', modules, job: { width, height }, files }, async (page) => {
  for (const scene of scenes) run('draw', scene, width, height, codesOf(page.folder, scene));
  console.log(`${page.renderer}\n${width}x${height}, ${rounds} rounds of ${frames} frames; milliseconds a frame`);
  console.log(''.padEnd(34) + 'peer: least, median, processor   Zoneplate: the same        ratios of the three' +
    '        changed %: here, there; pixels that differ by more than 1, %');
  for (const scene of scenes)
    for (const c of cases) await compare(scene, c, page);
});
