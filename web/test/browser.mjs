// Chromium, driven through its DevTools protocol over a pipe: no package is needed.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { decodePng } from '../report/png.js';

const flags = ['--headless=new', '--remote-debugging-pipe', '--no-first-run', '--no-default-browser-check', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-extensions', '--disable-gpu', '--hide-scrollbars', '--force-color-profile=srgb',
  '--font-render-hinting=none', '--disable-dev-shm-usage', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])];

export class Browser {
  constructor() {
    this.home = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-chromium-'));
    this.process = spawn('chromium', [...flags, `--user-data-dir=${this.home}`], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    this.ended = new Promise((end) => this.process.once('close', end));
    this.waiting = new Map(), this.pages = new Map(), this.count = 0;
    let rest = Buffer.alloc(0);
    this.process.stdio[4].on('data', (part) => {
      rest = Buffer.concat([rest, part]);
      for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) this.receive(JSON.parse(rest.subarray(0, end).toString()));
    });
  }

  receive({ id, result, error, method, params, sessionId }) {
    if (!id) return this.pages.get(sessionId)?.event(method, params);
    const { done, fail, name } = this.waiting.get(id);
    this.waiting.delete(id);
    if (error) fail(new Error(`${name}: ${error.message}`));
    else done(result);
  }

  send(name, params = {}, sessionId = undefined) {
    const id = ++this.count;
    this.process.stdio[3].write(JSON.stringify({ id, method: name, params, sessionId }) + '\0');
    return new Promise((done, fail) => this.waiting.set(id, { done, fail, name }));
  }

  /// A new page of a size in CSS pixels.
  async page({ width = 1280, height = 900, ratio = 1, scheme = 'light' } = {}) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    this.pages.set(sessionId, page);
    for (const domain of ['Page', 'Runtime', 'Log', 'Network', 'Accessibility']) await page.send(`${domain}.enable`);
    await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: ratio, mobile: false });
    await page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: scheme }, { name: 'prefers-reduced-motion', value: 'reduce' }] });
    return page;
  }

  async close() {
    await this.send('Browser.close').catch(() => {});
    await this.ended;
    fs.rmSync(this.home, { recursive: true, force: true });
  }
}

const keyCodes = { ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, Tab: 9, Enter: 13, Escape: 27, Home: 36, End: 35, ' ': 32 };

export class Page {
  constructor(browser, session, target) {
    Object.assign(this, { browser, session, target, problems: [], requests: [] });
  }
  send(name, params) { return this.browser.send(name, params, this.session); }

  event(name, params) {
    if (name === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    if (name === 'Runtime.exceptionThrown') this.problems.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (name === 'Runtime.consoleAPICalled') this.problems.push(`console: ${params.args.map((arg) => arg.value ?? arg.description).join(' ')}`);
    if (name === 'Log.entryAdded') this.problems.push(`log: ${params.entry.text}`);
    if (name === 'Page.loadEventFired') this.loaded?.();
  }

  /// Opens a file or an address.
  async open(place) {
    const loaded = new Promise((done) => (this.loaded = done));
    await this.send('Page.navigate', { url: place.includes('://') ? place : pathToFileURL(place).href });
    await loaded;
    await this.settle();
  }
  async close() { await this.browser.send('Target.closeTarget', { targetId: this.target }); }

  /// The value of an expression, or of a function that gets JSON arguments.
  async evaluate(what, ...args) {
    const expression = typeof what === 'function' ? `(${what})(...${JSON.stringify(args)})` : what;
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /// Waits until an expression is true.
  async until(expression, seconds = 10) {
    for (let i = 0; i < 20 * seconds; ++i) {
      if (await this.evaluate(expression)) return;
      await new Promise((done) => setTimeout(done, 50));
    }
    throw new Error(`not true after ${seconds} seconds: ${expression}`);
  }

  /// Waits for two painted frames after the decoding of the displayed pictures.
  settle() { return this.evaluate(() => new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30))), 120))); }

  async key(key, { shift = false, type = 'press' } = {}) {
    const code = keyCodes[key] ?? key.toUpperCase().charCodeAt(0), modifiers = shift ? 8 : 0;
    const text = key === 'Enter' ? '\r' : key.length === 1 ? key : undefined;
    if (type !== 'up') await this.send('Input.dispatchKeyEvent', { type: 'keyDown', key, windowsVirtualKeyCode: code, modifiers, text });
    if (type !== 'down') await this.send('Input.dispatchKeyEvent', { type: 'keyUp', key, windowsVirtualKeyCode: code, modifiers });
    await this.settle();
  }

  mouse(type, { x, y }, more = {}) { return this.send('Input.dispatchMouseEvent', { type, x, y, ...more }); }
  async move(place) { await this.mouse('mouseMoved', place); await this.settle(); }
  async drag(from, to) {
    const left = { button: 'left', buttons: 1, clickCount: 1 };
    await this.mouse('mouseMoved', from);
    await this.mouse('mousePressed', from, left);
    await this.mouse('mouseMoved', { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2 }, left);
    await this.mouse('mouseMoved', to, left);
    await this.mouse('mouseReleased', to, left);
    await this.settle();
  }
  async wheel(place, deltaY) { await this.mouse('mouseWheel', place, { deltaX: 0, deltaY }); await this.settle(); }
  async click(selector) {
    await this.evaluate((s) => document.querySelector(s).scrollIntoView({ block: 'center' }), selector);
    const box = await this.box(selector), place = { x: box.x + box.width / 2, y: box.y + box.height / 2 }, left = { button: 'left', buttons: 1, clickCount: 1 };
    await this.mouse('mouseMoved', place);
    await this.mouse('mousePressed', place, left);
    await this.mouse('mouseReleased', place, left);
    await this.settle();
  }

  /// The rectangle of an element in CSS pixels of the window.
  box(selector, i = 0) {
    return this.evaluate((s, n) => {
      const { x, y, width, height } = document.querySelectorAll(s)[n].getBoundingClientRect();
      return { x, y, width, height };
    }, selector, i);
  }

  /// A screenshot of the window as { width, height, data }, and as the bytes of a PNG.
  async shot() { return decodePng(new Uint8Array(await this.shotBytes())); }
  async shotBytes() { return Buffer.from((await this.send('Page.captureScreenshot', { format: 'png' })).data, 'base64'); }
}
