// The report in Chromium: what it displays is compared with the files that the same run wrote.
//
//   ZONEPLATE=build/check/zoneplate node --test web/test/report.test.mjs
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Browser } from './browser.mjs';
import { colorAt, picturesOf, readPage, readPng, writeExr, writePng } from './pictures.mjs';

const program = path.resolve(process.env.ZONEPLATE ?? 'build/check/zoneplate');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-report-'));
const at = (name) => path.join(folder, name);
function run(...args) {
  try {
    return execFileSync(program, args, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
  } catch (error) {
    if (error.status === 1) return error.stdout; // the images differ
    throw error;
  }
}

let browser;
const opened = [];
async function open(name, options) {
  const page = await browser.page(options);
  opened.push({ page, name });
  await page.open(at(name));
  await page.until('document.querySelectorAll("canvas").length > 0');
  await page.settle();
  return page;
}

const methods = ['none', 'fxaa', 'msaa:n=4', 'ssaa:n=4'];
const side = { width: 160, height: 120 };
/// Steps of 1/64 of a half float, with values above 1 and below 0.
const halfBits = (x, y) => [0x3c00 + x, 0x4400 + y, 0x3400 + x + y];

before(() => {
  browser = new Browser();
  run('compare', 'teapot', '--aa', methods.join(','), '--reference', 'ssaa:n=8', '--turns', '1', '-o', 'out', '--html', 'compare.html', '--quiet');
  const block = (x, y) => [x * 5 % 256, y * 7 % 256, (x ^ y) % 256], isMark = (x, y) => x === 100 && y === 60;
  writePng(at('a.png'), side.width, side.height, (x, y) => (isMark(x, y) ? [255, 0, 255] : block(x, y)));
  writePng(at('b.png'), side.width, side.height, (x, y) => (isMark(x, y) ? [255, 0, 0] : block(x + 2, y)));
  run('metrics', 'a.png', 'b.png', '--report', 'pair.html');
  writeExr(at('a.exr'), 64, 48, halfBits);
  writeExr(at('b.exr'), 64, 48, (x, y) => halfBits(x, y).map((bits) => bits + 8));
  run('metrics', 'a.exr', 'b.exr', '--report', 'light.html');
  for (const kind of ['golden', 'made']) {
    fs.mkdirSync(at(kind));
    for (let t = 0; t < 4; ++t)
      writePng(at(`${kind}/f${t}.png`), 64, 48, (x, y) => (x === 8 * t + (kind === 'made' && t > 1 ? 1 : 0) ? [255, 255, 255] : [10 * t, y, 0]));
  }
  run('metrics', 'golden', 'made', '--report', 'film.html', '--metric', 'mae,psnr');
  run('compare', 'passing-fence', '--aa', 'none,taa', '--reference', 'ssaa:n=4', '--frames', '4', '--size', '64x48', '-o', 'moving', '--html', 'moving.html', '--quiet');
});

after(async () => {
  for (const { page, name } of opened) {
    assert.deepEqual(page.problems, [], `${name}: messages on the console`);
    assert.equal(page.requests.filter((url) => !url.startsWith('data:') && !url.startsWith('blob:')).length, 1, `${name}: ${page.requests}`);
  }
  await browser.close();
  fs.rmSync(folder, { recursive: true });
});

/// The place of a pane; its corner is rounded as the browser does when it paints.
async function paneBox(page, i = 0) {
  const { x, y, width, height } = await page.box('.room canvas', i);
  return { x: Math.round(x), y: Math.round(y), width, height };
}
const press = async (page, ...keys) => { for (const key of keys) await page.key(key); };
/// Chooses a zoom of the list, such as "8×".
const zoom = (page, text) => page.evaluate((wanted) => {
  const list = document.querySelector('select[aria-label="Zoom"]');
  list.selectedIndex = [...list.options].findIndex((option) => option.text === wanted);
  list.dispatchEvent(new Event('change'));
}, text).then(() => page.settle());
const textsOf = (page, selector) => page.evaluate((s) => [...document.querySelectorAll(s)].map((node) => node.textContent), selector);

/// The bounding box, relative to a pane, of the pixels of a colour.
function placeOf(shot, box, [r, g, b]) {
  let left = Infinity, right = -1, top = Infinity, bottom = -1;
  for (let y = 0; y < box.height; ++y)
    for (let x = 0; x < box.width; ++x) {
      const c = colorAt(shot, box.x + x, box.y + y);
      if (c[0] !== r || c[1] !== g || c[2] !== b) continue;
      left = Math.min(left, x), right = Math.max(right, x), top = Math.min(top, y), bottom = Math.max(bottom, y);
    }
  return { left, top, width: right - left + 1, height: bottom - top + 1 };
}

/// Asserts that a pane displays a picture at 1×, bit by bit.
function assertDisplays(shot, box, picture, from = 0, to = picture.width) {
  const left = box.x + (box.width - picture.width) / 2, top = box.y + (box.height - picture.height) / 2;
  let differing = 0;
  for (let y = 0; y < picture.height; ++y)
    for (let x = from; x < to; ++x) {
      const a = colorAt(shot, Math.round(left) + x, Math.round(top) + y), b = colorAt(picture, x, y);
      differing += a.some((code, c) => code !== b[c]);
    }
  assert.equal(differing, 0, `${differing} pixels differ`);
}

/// Waits until a pane displays a picture at 1×, which may have to be decoded first.
async function waitForPicture(page, box, picture) {
  for (let i = 0; i < 40; ++i) {
    try {
      return assertDisplays(await page.shot(), box, picture);
    } catch {
      await page.settle();
    }
  }
  return assertDisplays(await page.shot(), box, picture);
}

test('the page is at most 1.3 times as large as its pictures', () => {
  const names = fs.readdirSync(at('out/teapot')).filter((name) => name.endsWith('.png') && !/worst|crops/.test(name));
  assert.equal(names.length, 1 + 2 * methods.length);
  const pictures = names.reduce((sum, name) => sum + fs.statSync(at(`out/teapot/${name}`)).size, 0), page = fs.statSync(at('compare.html')).size;
  console.log(`page: ${page} bytes, ${(page / pictures).toFixed(2)} times its pictures`);
  assert.ok(page <= 1.3 * pictures);
  // Of the pictures that are in it, which are smaller: 8/7 as large, and the viewer and the data.
  const own = picturesOf(at('compare.html')).reduce((sum, { length }) => sum + length, 0), rest = page - own * 8 / 7;
  console.log(`${(page / own).toFixed(3)} times the pictures inside, and ${Math.round(rest)} bytes of viewer and data`);
  assert.ok(page <= 1.3 * own && rest < 30000);
});

test('zoom and pan are linked to one CSS pixel from 1 to 64 times', async () => {
  const page = await open('pair.html');
  await zoom(page, '1×');
  const colors = [[255, 0, 255], [255, 0, 0]];
  const marks = async () => {
    const shot = await page.shot();
    return Promise.all(colors.map(async (color, i) => placeOf(shot, await paneBox(page, i), color)));
  };
  for (const factor of [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64]) {
    const [first, second] = await marks();
    assert.deepEqual([first.width, first.height], [factor, factor], `${factor}×`);
    assert.deepEqual(second, first, `${factor}×`);
    // The wheel keeps the pixel under the pointer where it is, in each pane.
    const box = await paneBox(page, factor % 4 === 0 ? 1 : 0);
    await page.wheel({ x: box.x + first.left + (first.width >> 1), y: box.y + first.top + (first.height >> 1) }, -100);
  }
  const before = (await marks())[0], box = await paneBox(page);
  await page.drag({ x: box.x + 30, y: box.y + 40 }, { x: box.x + 53, y: box.y + 51 });
  for (const mark of await marks()) assert.deepEqual(mark, { ...before, left: before.left + 23, top: before.top + 11 });
  await page.close();
});

test('images alternate without a shift, bit by bit as in their files', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  await press(page, '1');
  await zoom(page, '1×');
  const box = await paneBox(page);
  for (const [key, name] of [['1', 'none'], ['2', 'fxaa'], ['4', 'ssaa-n-4'], ['0', 'reference'], ['1', 'none']]) {
    await press(page, key);
    assert.deepEqual(await paneBox(page), box);
    assertDisplays(await page.shot(), box, await readPng(at(`out/teapot/${name}.png`)));
  }
  for (const key of ['r', ' ']) {
    await page.key(key, { type: 'down' });
    assertDisplays(await page.shot(), box, await readPng(at('out/teapot/reference.png')));
    await page.key(key, { type: 'up' });
    assertDisplays(await page.shot(), box, await readPng(at('out/teapot/none.png')));
  }
  await page.close();
});

test('the slider divides reference and image', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  await press(page, '2', 's');
  await zoom(page, '1×');
  const box = await paneBox(page), handle = await page.box('.handle'), y = box.y + box.height / 2;
  await page.drag({ x: handle.x + handle.width / 2, y }, { x: box.x + 0.3 * box.width, y });
  const left = (box.width - 640) / 2, edge = Math.round(0.3 * box.width - left), shot = await page.shot();
  assertDisplays(shot, { ...box, height: box.height }, await readPng(at('out/teapot/fxaa.png')), edge + 20);
  assertDisplays(shot, { ...box, height: box.height }, await readPng(at('out/teapot/reference.png')), 0, edge - 20);
  await page.evaluate(() => document.querySelector('.handle').focus());
  await press(page, 'End');
  assert.equal(await page.evaluate(() => document.querySelector('.handle').getAttribute('aria-valuenow')), '100');
  await page.close();
});

test('differences and error maps have the values of the files', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  await press(page, '1');
  await zoom(page, '1×');
  const box = await paneBox(page), none = await readPng(at('out/teapot/none.png')), reference = await readPng(at('out/teapot/reference.png'));
  const difference = { ...none, data: none.data.map((code, i) => (i % 4 === 3 ? 255 : Math.min(255, 4 * Math.abs(code - reference.data[i])))) };
  await press(page, 'd');
  assertDisplays(await page.shot(), box, difference);
  await press(page, 'e');
  const shot = await page.shot(), map = await readPng(at('out/teapot/none.error.png'));
  assertDisplays(shot, box, map);
  await page.close();
});

test('the inspector has the values of the PNG files', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  await press(page, '1');
  await zoom(page, '1×');
  const box = await paneBox(page), left = box.x + (box.width - 640) / 2, top = box.y + (box.height - 480) / 2;
  const pictures = [await readPng(at('out/teapot/reference.png')), await readPng(at('out/teapot/none.png'))];
  const decode = (code) => { const v = code / 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; };
  for (const [x, y] of [[0, 0], [639, 479], [320, 200], [333, 181], [250, 300]]) {
    await page.move({ x: left + x + 0.5, y: top + y + 0.5 });
    assert.equal((await textsOf(page, '.inspector caption'))[0], `Pixel ${x}, ${y}`);
    const rows = await page.evaluate(() => [...document.querySelectorAll('.inspector tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent)));
    assert.deepEqual(rows.map((row) => row[0]), ['ssaa:n=8', 'none']);
    pictures.forEach((picture, i) => {
      const codes = colorAt(picture, x, y);
      assert.deepEqual(rows[i].slice(1, 4).map(Number), codes);
      rows[i].slice(4, 7).forEach((text, c) => assert.ok(Math.abs(Number(text) - decode(codes[c])) < 1e-6));
    });
  }
  await page.close();
});

test('light of EXR files keeps its values, and has an exposure', async () => {
  const page = await open('light.html', { width: 1400, height: 1100 });
  await press(page, '0');
  await zoom(page, '8×');
  const box = await paneBox(page), left = box.x + (box.width - 512) / 2, top = box.y + (box.height - 384) / 2;
  const valueOf = (bits) => (1 + (bits & 1023) / 1024) * 2 ** ((bits >> 10) - 15);
  const encode = (v) => Math.floor(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055) + 0.5);
  for (const [x, y] of [[0, 0], [63, 47], [17, 30]]) {
    await page.move({ x: left + 8 * x + 4, y: top + 8 * y + 4 });
    const row = await page.evaluate(() => [...document.querySelector('.inspector tbody tr').children].map((cell) => cell.textContent));
    const light = halfBits(x, y).map(valueOf).reverse();
    row.slice(4, 7).forEach((text, c) => assert.ok(Math.abs(Number(text) - light[c]) < light[c] * 2 ** -12, `${text} for ${light[c]}`)); // no other half is as near
    assert.deepEqual(row.slice(1, 4).map(Number), light.map((v) => encode(Math.min(1, v))));
  }
  for (const stops of [0, -1, -2]) {
    const shot = await page.shot(), color = colorAt(shot, Math.round(left) + 8 * 20 + 4, Math.round(top) + 8 * 40 + 4);
    assert.deepEqual(color, halfBits(20, 40).map((bits) => encode(Math.min(1, valueOf(bits) * 2 ** stops))).reverse(), `${stops} EV`);
    await press(page, '[', '[');
  }
  await page.close();
});

test('tables are sorted by any column, and select images', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  const column = (n) => page.evaluate((i) => [...document.querySelectorAll('.details tbody tr')].map((row) => row.children[i].textContent), n);
  const heads = await textsOf(page, '.details thead th');
  for (const name of ['PSNR dB', 'FLIP ×1000', 'CPU ms']) {
    const n = heads.indexOf(name);
    for (const direction of [1, -1]) {
      await page.click(`.details thead th:nth-child(${n + 1}) button`);
      const values = (await column(n)).map(Number);
      assert.equal(values.length, methods.length);
      assert.deepEqual(values, [...values].sort((a, b) => direction * (a - b)), name);
      assert.equal(await page.evaluate((i) => document.querySelectorAll('.details thead th')[i].getAttribute('aria-sort'), n), direction > 0 ? 'ascending' : 'descending');
    }
  }
  await page.evaluate(() => [...document.querySelectorAll('.details tbody th button')].find((b) => b.textContent === 'msaa:n=4').click());
  await page.settle();
  assert.deepEqual(await textsOf(page, '.details tbody tr.selected th button'), ['msaa:n=4']);
  await page.close();
});

test('points of the plot have names and select images', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  const names = await page.evaluate(() => [...document.querySelectorAll('.point')].map((point) => point.getAttribute('aria-label').split(': ')[0]));
  assert.deepEqual([...names].sort(), [...methods].sort());
  await press(page, 'f');
  await page.evaluate(() => document.querySelector('.point[aria-label^="ssaa"]').focus());
  await press(page, 'Enter');
  assert.deepEqual(await textsOf(page, '.room .name'), ['ssaa:n=4']);
  await page.click('.point[aria-label^="none"] .dot');
  assert.deepEqual(await textsOf(page, '.room .name'), ['none']);
  await page.close();
});

test('sequences are stepped, played and sliced', async () => {
  const page = await open('film.html', { width: 1400, height: 1100 });
  await press(page, '1');
  await zoom(page, '8×');
  for (let t = 0; t < 4; ++t) {
    assert.match((await textsOf(page, '.sequence output'))[0], new RegExp(`frame ${t + 1} of 4`));
    const box = await paneBox(page), shot = await page.shot(), made = await readPng(at(`made/f${t}.png`));
    const left = Math.round(box.x + (box.width - 512) / 2), top = Math.round(box.y + (box.height - 384) / 2);
    for (const [x, y] of [[8 * t, 3], [8 * t + 1, 3], [40, 40]]) assert.deepEqual(colorAt(shot, left + 8 * x + 4, top + 8 * y + 4), colorAt(made, x, y));
    await press(page, '.');
  }
  assert.match((await textsOf(page, '.sequence output'))[0], /frame 1 of 4/);
  await press(page, 't'); // row 24 of the four frames, 12 rows of the slice each
  await page.settle();
  const box = await paneBox(page), shot = await page.shot();
  const left = Math.round(box.x + (box.width - 512) / 2), top = Math.round(box.y + (box.height - 384) / 2);
  for (let t = 0; t < 4; ++t) {
    const made = await readPng(at(`made/f${t}.png`));
    for (const x of [8 * t, 8 * t + 1, 50]) assert.deepEqual(colorAt(shot, left + 8 * x + 4, top + 8 * (12 * t + 6) + 4), colorAt(made, x, 24));
  }
  await press(page, 'i', 'p');
  await page.until('document.querySelector(".sequence output").textContent.startsWith("frame 3")');
  await press(page, 'p');
  await page.click('.table:last-of-type tbody tr:nth-child(2) button');
  await page.close();
});

test('a comparison of sequences has every frame and its error map', async () => {
  const page = await open('moving.html', { width: 1400, height: 1100 }), { content, pictures } = await readPage(at('moving.html'));
  const [reference, ...methods] = content.scenes[0].images;
  for (const { frames, errors } of methods) assert.deepEqual([frames.length, errors.length], [4, 4]);
  assert.match((await textsOf(page, '.sequence output'))[0], /frame 4 of 4/);
  await press(page, '2');
  await zoom(page, '1×');
  const box = await paneBox(page);
  await waitForPicture(page, box, await readPng(at('moving/passing-fence/taa.png')));
  for (let t = 0; t < 4; ++t) {
    await press(page, '.');
    await waitForPicture(page, box, pictures[methods[1].frames[t]]);
    await press(page, '0');
    await waitForPicture(page, box, pictures[reference.frames[t]]);
    await press(page, '2');
  }
  assert.notDeepEqual(pictures[methods[1].frames[0]].data, pictures[methods[1].frames[3]].data);
  await press(page, 'e');
  await waitForPicture(page, box, await readPng(at('moving/passing-fence/taa.error.png')));
  await page.close();
});

test('the keyboard suffices, and every control has a name', async () => {
  const page = await open('compare.html', { width: 1400, height: 1100 });
  const { nodes } = await page.send('Accessibility.getFullAXTree');
  const controls = nodes.filter((node) => ['button', 'slider', 'combobox', 'image', 'img', 'link', 'textbox'].includes(node.role?.value) && !node.ignored);
  assert.ok(controls.length > 30);
  for (const node of controls) assert.ok(node.name?.value?.trim(), `a ${node.role.value} has no name`);
  const images = controls.filter((node) => /^ima?ge?$/.test(node.role.value)).map((node) => node.name.value);
  assert.ok(images.some((name) => name.startsWith('fxaa: image, ')), images.join('; '));

  const reached = new Set();
  for (let i = 0; i < 80; ++i) {
    await page.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'Tab', windowsVirtualKeyCode: 9 });
    await page.send('Input.dispatchKeyEvent', { type: 'keyUp', key: 'Tab', windowsVirtualKeyCode: 9 });
    reached.add(await page.evaluate(() => { const a = document.activeElement; return `${a.tagName.toLowerCase()}.${a.getAttribute('class') ?? ''}`; }));
  }
  for (const control of ['button.', 'select.', 'input.', 'div.room', 'button.link']) assert.ok(reached.has(control), `${control} is not reached: ${[...reached]}`);
  assert.ok([...reached].some((control) => control.startsWith('g.point')));

  await page.evaluate(() => document.querySelector('.room').focus());
  await zoom(page, '32×');
  await page.evaluate(() => document.querySelector('.room').focus());
  await page.key('ArrowRight', { shift: true });
  const pixelNow = async () => (await textsOf(page, '.inspector caption'))[0].match(/\d+/g).map(Number);
  const first = await pixelNow();
  await page.key('ArrowRight', { shift: true });
  await page.key('ArrowDown', { shift: true });
  assert.deepEqual(await pixelNow(), [first[0] + 1, first[1] + 1]);
  const before = await page.shot();
  await press(page, 'ArrowLeft');
  assert.notDeepEqual((await page.shot()).data, before.data);
  await press(page, '?');
  assert.ok(await page.evaluate('document.querySelector("dialog").open'));
  assert.deepEqual((await textsOf(page, 'dialog dt')).slice(0, 2), ['0 – 9', 'R or space, held']);
  assert.doesNotMatch((await textsOf(page, 'dialog'))[0], /object/);
  await press(page, 'Escape');
  assert.ok(!(await page.evaluate('document.querySelector("dialog").open')));
  await page.close();
});

test('narrow and dark windows are served', async () => {
  const luminance = async (page) => { const shot = await page.shot(); return colorAt(shot, 2, 2).reduce((a, b) => a + b) / 3; };
  for (const width of [360, 768, 1920]) {
    const page = await open('compare.html', { width, height: 800 });
    assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth'), `${width}: scrolls sideways`);
    await page.close();
  }
  const light = await open('pair.html'), dark = await open('pair.html', { scheme: 'dark' });
  assert.ok(await luminance(light) > 220);
  assert.ok(await luminance(dark) < 60);
});

test('the image of the documents is that of the commands below it', async () => {
  const blocks = [...fs.readFileSync(path.resolve('docs/ci.md'), 'utf8').matchAll(/```sh\n(.*?)```/gs)].map((match) => match[1]);
  const commands = blocks.find((block) => block.includes('photograph.mjs')), place = at('picture');
  fs.mkdirSync(path.join(place, 'docs'), { recursive: true });
  fs.symlinkSync(program, path.join(place, 'zoneplate'));
  fs.symlinkSync(path.resolve('web'), path.join(place, 'web'));
  execFileSync('bash', ['-c', commands], { cwd: place, stdio: ['ignore', 'ignore', 'pipe'] });
  const [now, shown] = [path.join(place, 'docs/report.png'), path.resolve('docs/report.png')].map(readPng), pictures = await Promise.all([now, shown]);
  assert.deepEqual([pictures[0].width, pictures[0].height], [pictures[1].width, pictures[1].height]);
  const difference = pictures[0].data.reduce((sum, value, i) => sum + Math.abs(value - pictures[1].data[i]), 0) / pictures[0].data.length;
  assert.ok(difference < 1, `mean difference ${difference}`); // another version of Chromium may draw letters otherwise
});
