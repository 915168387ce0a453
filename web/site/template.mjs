// The frame of every page of the site.
import path from 'node:path';

export const escapeText = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;').replaceAll('"', '&quot;');

/// The list of a page's sections.
function contentsOf(body) {
  const heads = [...body.matchAll(/<h2 id="([^"]*)">(.*?)<\/h2>/gs)];
  if (heads.length < 3) return '';
  return `<aside class="contents" aria-label="On this page"><strong>On this page</strong><ul>${heads.map(([, id, text]) => `<li><a href="#${id}">${text.replace(/<a [^>]*>|<\/a>/g, '')}</a></li>`).join('')}</ul></aside>`;
}

/// The documents under the names of their groups.
function listOf(documents, itemOf) {
  const groups = [...new Set(documents.map(({ group }) => group))];
  return groups.map((name) => `<strong>${name}</strong><ul>${documents.filter(({ group }) => group === name).map(itemOf).join('')}</ul>`).join('');
}

export function pageOf({ name, title, body, active, documents }) {
  const to = (target) => path.relative(path.dirname(name), target);
  const here = (target) => (target === active ? ' aria-current="page"' : '');
  const places = [['index.html', 'Documentation'], ['lessons/index.html', 'Lessons'], ['gallery/index.html', 'Gallery'], ['playground/index.html', 'Playground'], ['api/index.html', 'C++ API']];
  const isDocument = documents.some((document) => document.name === active);
  const current = (target) => (isDocument && target === 'index.html' ? ' aria-current="page"' : here(target));
  const list = isDocument ? `<nav class="documents" aria-label="Documents">${listOf(documents, (document) => `<li><a href="${to(document.name)}"${here(document.name)}>${escapeText(document.title)}</a></li>`)}</nav>` : '';
  return `<!doctype html>
<html lang="en" data-theme="auto">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>${escapeText(title)}${title === 'Zoneplate' ? '' : ' – Zoneplate'}</title>
<link rel="stylesheet" href="${to('site.css')}">
</head>
<body data-root="${to('.') || '.'}" class="${isDocument ? 'document' : ''}">
<a class="skip" href="#content">To the text</a>
<header><a class="home" href="${to('index.html')}">Zoneplate</a>
<nav aria-label="Site">${places.map(([target, text]) => `<a href="${to(target)}"${current(target)}>${text}</a>`).join('')}</nav>
<div class="search" role="search"><input type="search" placeholder="Search" aria-label="Search" aria-keyshortcuts="/" autocomplete="off"><ol hidden></ol></div>
<button type="button" id="theme">Theme: auto</button></header>
<div class="page">${list}<main id="content">${body}</main>${isDocument ? contentsOf(body) : ''}</div>
<script src="${to('search-index.js')}"></script>
<script src="${to('site.js')}"></script>
</body>
</html>
`;
}
