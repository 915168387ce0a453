// The site: its links, and every page from a file and from a server.
//
//   SITE=build/web/site node --test web/test/site.test.mjs
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Browser } from './browser.mjs';
import { serve } from './server.mjs';

const site = path.resolve(process.env.SITE ?? 'build/web/site');
/// Every page but those of Doxygen, by its path in the site.
const pages = fs.readdirSync(site, { recursive: true }).filter((name) => name.endsWith('.html') && !name.startsWith('api/')).sort();
const read = (name) => fs.readFileSync(path.join(site, name), 'utf8');

let browser, server;
before(async () => { browser = new Browser(), server = await serve(site); });
after(async () => { await browser.close(); await server.close(); });

test('no link of a document is broken', () => {
  const idsOf = new Map();
  const ids = (name) => idsOf.get(name) ?? idsOf.set(name, new Set([...read(name).matchAll(/ id="([^"]*)"/g)].map(([, id]) => id))).get(name);
  let links = 0;
  for (const page of pages.filter((name) => !/^(lessons|gallery)\/(?!index)/.test(name)))
    for (const [, link] of read(page).matchAll(/ (?:href|src)="([^"]*)"/g)) {
      if (/^(https?|data|mailto):/.test(link)) continue;
      const [file, fragment] = link.split('#'), target = file ? path.normalize(path.join(path.dirname(page), file)) : page;
      assert.ok(fs.existsSync(path.join(site, target)), `${page} links to ${link}`);
      if (fragment && !target.startsWith('playground/')) assert.ok(ids(target).has(decodeURIComponent(fragment)), `${page} links to ${link}`);
      ++links;
    }
  assert.ok(links > 500, `${links} links`);
  for (const page of pages.filter((name) => /^(lessons|gallery)\/(?!index)/.test(name))) assert.ok(read(page).includes('<a href="index.html">'), `${page} leads nowhere`);
});

for (const [kind, addressOf] of [['a file', (name) => path.join(site, name)], ['a server', (name) => `${server.address}/${name}`]]) {
  test(`every page opens from ${kind} without a message`, async () => {
    assert.ok(pages.length > 50);
    for (const name of pages) {
      const page = await browser.page({ width: 1100, height: 800 });
      await page.open(addressOf(name));
      assert.ok((await page.evaluate('document.body.innerText')).trim().length > 20, `${name} is empty`);
      assert.deepEqual(page.problems, [], `${name} from ${kind}`);
      await page.close();
    }
  });
}

test('the search finds a section, by keys alone', async () => {
  const page = await browser.page();
  await page.open(path.join(site, 'docs/compare.html'));
  await page.key('/');
  for (const key of 'fsr2') await page.key(key);
  const found = await page.evaluate('[...document.querySelectorAll(".search li a")].map((a) => a.getAttribute("href"))');
  assert.ok(found.some((href) => href.includes('docs/upscaling.html')), String(found));
  await page.key('Enter');
  await page.until('!location.pathname.endsWith("compare.html")');
  assert.deepEqual(page.problems, []);
});

test('a page of the playground that is a file states what to do', async () => {
  const page = await browser.page();
  await page.open(path.join(site, 'playground/index.html'));
  assert.match(await page.evaluate('document.body.innerText'), /python3 -m http\.server/);
});

test('no page is wider than a narrow window', async () => {
  for (const name of pages.filter((page) => !/^(playground\/|(lessons|gallery)\/(?!index))/.test(page))) {
    const page = await browser.page({ width: 390, height: 800 });
    await page.open(path.join(site, name));
    assert.ok(await page.evaluate('document.documentElement.scrollWidth') <= 390, name);
    await page.close();
  }
});
