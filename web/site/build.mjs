// Makes the site: one folder of the documents, the lessons, the gallery, the API reference and the playground.
//
//   node web/site/build.mjs PROGRAM PLAYGROUND THREADS API FOLDER
//
// PROGRAM is the native program, PLAYGROUND the folder with zoneplate_playground.js and .wasm, THREADS that of the same with
// threads, API that of Doxygen's pages.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { lessonOf, lessons } from '../playground/lessons.js';
import { argumentsOf, pairsOf } from '../playground/state.js';
import { documentGroups, failures } from './content.mjs';
import { escapeText, pageOf } from './template.mjs';
import { rendered, sectionsOf } from './markdown.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const font = '/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf';
const [program, playground, threads, api, out] = process.argv.slice(2).map((argument) => path.resolve(argument));
const at = (...parts) => path.join(out, ...parts);
const run = (...args) => execFileSync(program, args, { cwd: out, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
const index = [];

/// Writes a page of the site; `name` is its path from the site's folder.
function writePage(name, title, body, active) {
  fs.mkdirSync(path.dirname(at(name)), { recursive: true });
  fs.writeFileSync(at(name), pageOf({ name, title, body, active, documents }));
  index.push(...sectionsOf(body).map(({ id, heading, text }) => ({ page: id ? `${name}#${id}` : name, title, heading, text })));
}

// ---- the documents

const sources = [...fs.readdirSync(path.join(root, 'docs')).filter((name) => name.endsWith('.md')).sort().map((name) => `docs/${name}`), ...documentGroups.flatMap(([, group]) => group)];
const others = [...new Set(sources)].filter((source) => !documentGroups.some(([, group]) => group.includes(source)));
/// { source, name, title, group } of every document; the page of README.md is the first of the site.
const documents = [...documentGroups, ['More', others]].flatMap(([group, list]) => list.map((source) => ({
  source, group,
  name: source === 'README.md' ? 'index.html' : `${source.startsWith('docs/') ? '' : 'docs/'}${source.slice(0, -3)}.html`.replace(/[^/]*$/, (file) => file.toLowerCase()),
  title: /^#+ (.*)$/m.exec(fs.readFileSync(path.join(root, source), 'utf8'))[1].replaceAll('`', ''),
})));

/// The address, from a page, of a file that a document names; null if the site does not have it.
function addressOf(link, source, name) {
  if (/^[a-z]+:/.test(link)) return link;
  const [file, fragment] = link.split('#');
  if (!file) return link;
  const target = path.normalize(path.join(path.dirname(source), file));
  const known = documents.find((document) => document.source === target)?.name ?? (/\.(png|svg)$/.test(target) ? target : null);
  if (!known) return null;
  if (known === target) fs.mkdirSync(path.dirname(at(target)), { recursive: true }), fs.copyFileSync(path.join(root, target), at(target));
  return path.relative(path.dirname(name), known) + (fragment ? `#${fragment}` : '');
}

/// Where a visitor goes who does not read: below the images of the first page.
const doors = `<ul class="cards doors">${[['playground/index.html', 'Playground', 'Render scenes and models in this browser by two methods, and compare them pixel by pixel.'],
  ['lessons/index.html', 'Lessons', 'Artifacts and their remedies, side by side, with measurements and parameters to change.'],
  ['gallery/index.html', 'Gallery', 'Scenes in which antialiasing fails, by several methods, with errors and costs.']]
  .map(([href, title, text]) => `<li><a class="card" href="${href}"><strong>${title}</strong><span>${text}</span></a></li>`).join('')}</ul>`;

function writeDocuments() {
  for (const { source, name, title } of documents) {
    const body = rendered(fs.readFileSync(path.join(root, source), 'utf8'), (link) => addressOf(link, source, name));
    writePage(name, title, name === 'index.html' ? body.replace('</table></div>', () => `</table></div>${doors}`) : body, name);
  }
}

// ---- lessons and gallery: pages that the program writes

const card = (href, title, text, image) => `<a class="card" href="${href}">${image ? `<img src="${image}" alt="" loading="lazy">` : ''}<strong>${escapeText(title)}</strong><span>${escapeText(text)}</span></a>`;

/// Adds the way back to a page of the program. Its bytes are kept.
function addWayBack(name, title) {
  const page = fs.readFileSync(at(name), 'latin1');
  fs.writeFileSync(at(name), page.replace('<body>', () => `<body>\n<p style="margin: .75rem 1rem 0"><a href="index.html">&larr; ${title}</a></p>`), 'latin1');
}

/// A link to the first step of a lesson of the playground.
const liveLink = (name, text) => `<a class="live" href="../playground/index.html#lesson=${name}&amp;${escapeText(new URLSearchParams(lessonOf(name).steps[0].state).toString())}">${text}</a>`;

function writeLessons() {
  fs.mkdirSync(at('lessons'), { recursive: true });
  const listed = run('demo', '--help').split('\nLessons:\n')[1].split('\n').map((line) => /^ {2}([a-z-]+) {2,}(.*)$/.exec(line)).filter((match) => match && match[1] !== 'all');
  const cards = listed.map(([, name, summary]) => {
    run('demo', name, '--html', `lessons/${name}.html`, '-o', `lessons/${name}.png`);
    addWayBack(`lessons/${name}.html`, 'Lessons');
    const drawn = `<a class="live" href="../playground/index.html#demo=${name}">Change its parameters</a>`;
    const live = drawn + (lessonOf(name) ? liveLink(name, 'Continue step by step') : '');
    index.push({ page: `lessons/${name}.html`, title: 'Lessons', heading: name, text: summary });
    return `<li>${card(`${name}.html`, name, summary, `${name}.png`)}${live}</li>`;
  });
  const more = lessons.filter(({ name }) => !listed.some((row) => row[1] === name));
  writePage('lessons/index.html', 'Lessons', `<h1>Lessons</h1><p>Each lesson displays an artifact, its remedy and measurements. Its page has the images of the lesson at
every zoom. The playground draws every lesson anew for other parameters; some continue there as lessons of several steps.</p><ul class="cards">${cards.join('')}</ul>
<h2 id="playground">Lessons of the playground alone</h2><ul>${more.map(({ name, title }) => `<li>${liveLink(name, title).replace(' class="live"', '')}</li>`).join('')}</ul>`, 'lessons/index.html');
}

function writeGallery() {
  fs.mkdirSync(at('gallery'), { recursive: true });
  const { scenes } = JSON.parse(run('list', 'scenes', '--json'));
  const cards = failures.map(({ scene, methods, frames, size, look = '' }) => {
    const options = argumentsOf(pairsOf(look));
    const more = frames ? ['--frames', String(frames)] : ['--turns', '1'];
    run('compare', scene, '--aa', methods, '--size', size, '--html', `gallery/${scene}.html`, '--quiet', ...more, ...options);
    addWayBack(`gallery/${scene}.html`, 'Gallery');
    run('render', scene, '--aa', 'none', '--size', '320x180', '-o', `gallery/${scene}.png`, '--quiet', ...options);
    const { summary, artifact } = scenes.find(({ name }) => name === scene), about = artifact || summary;
    index.push({ page: `gallery/${scene}.html`, title: 'Gallery', heading: scene, text: about });
    return `<li>${card(`${scene}.html`, scene, about, `${scene}.png`)}<a class="live" href="../playground/index.html#scene=${scene}&a=none&b=msaa:n=8${look ? `&looka=${look}&lookb=${look}` : ''}">Open in the playground</a></li>`;
  });
  writePage('gallery/index.html', 'Gallery', `<h1>Gallery</h1><p>Scenes in which antialiasing fails, each with a report: images by several methods, their errors against a
reference, and their cost.</p><ul class="cards">${cards.join('')}</ul>`, 'gallery/index.html');
}

// ---- the playground and the API reference

function copyPlayground() {
  fs.mkdirSync(at('playground/report'), { recursive: true });
  for (const name of fs.readdirSync(path.join(root, 'web/playground')).filter((file) => /\.(html|js|css)$/.test(file)))
    fs.copyFileSync(path.join(root, 'web/playground', name), at('playground', name));
  for (const name of fs.readdirSync(path.join(root, 'web/report')).filter((file) => /\.(js|css)$/.test(file)))
    fs.copyFileSync(path.join(root, 'web/report', name), at('playground/report', name));
  fs.mkdirSync(at('playground/threads'));
  for (const name of ['zoneplate_playground.js', 'zoneplate_playground.wasm']) {
    fs.copyFileSync(path.join(playground, name), at('playground', name));
    fs.copyFileSync(path.join(threads, name), at('playground/threads', name));
  }
  fs.copyFileSync(path.join(threads, 'zoneplate_playground.worker.js'), at('playground/threads/zoneplate_playground.worker.js'));
  const weights = path.join(root, 'src/zoneplate/network/weights');
  fs.mkdirSync(at('playground/weights'));
  for (const name of fs.readdirSync(weights).filter((file) => file.endsWith('.bin')))
    fs.copyFileSync(path.join(weights, name), at('playground/weights', name));
  // The font of drawings in lessons, with its licence.
  fs.copyFileSync(font, at('playground/DejaVuSans.ttf'));
  fs.copyFileSync('/usr/share/doc/fonts-dejavu-core/copyright', at('playground/DejaVuSans.txt'));
  // The prepared studio, from the cache of the program: the page would need seconds for it.
  const cache = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-cache-'));
  execFileSync(program, ['render', 'teapot', '--size', '16', '-o', path.join(cache, 'image.png'), '--quiet'], { env: { ...process.env, XDG_CACHE_HOME: cache } });
  const [made] = fs.readdirSync(path.join(cache, 'zoneplate')).filter((name) => name.endsWith('.env'));
  fs.copyFileSync(path.join(cache, 'zoneplate', made), at('playground/studio.env'));
  fs.rmSync(cache, { recursive: true });
}

/// Doxygen's pages, with the way back to the site, and colours for dark windows.
function copyReference() {
  fs.cpSync(api, at('api'), { recursive: true });
  for (const name of fs.readdirSync(at('api')).filter((file) => file.endsWith('.html'))) {
    const page = fs.readFileSync(at('api', name), 'utf8');
    fs.writeFileSync(at('api', name), page.replace('<div id="projectname">Zoneplate', '<div id="projectname"><a href="../index.html">Zoneplate</a>'));
  }
  fs.appendFileSync(at('api/doxygen.css'), fs.readFileSync(path.join(root, 'web/site/reference.css'), 'utf8'));
}

fs.rmSync(out, { recursive: true, force: true });
fs.mkdirSync(out, { recursive: true });
copyPlayground();
copyReference();
for (const name of ['site.css', 'site.js']) fs.copyFileSync(path.join(root, 'web/site', name), at(name));
writeDocuments();
writeLessons();
writeGallery();
fs.writeFileSync(at('search-index.js'), `window.searchIndex = ${JSON.stringify(index)};\n`);
