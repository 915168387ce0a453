// Photographs a page in Chromium: node web/test/photograph.mjs PAGE.html OUT.png WIDTHxHEIGHT
import fs from 'node:fs';
import path from 'node:path';
import { Browser } from './browser.mjs';

const [page, out, size] = process.argv.slice(2), [width, height] = size.split('x').map(Number);
const browser = new Browser();
const opened = await browser.page({ width, height });
await opened.open(path.resolve(page));
fs.writeFileSync(out, await opened.shotBytes());
await browser.close();
