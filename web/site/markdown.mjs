// Markdown to HTML by cmark-gfm, with anchors of headings as GitHub makes them.
import { execFileSync } from 'node:child_process';

const textOf = (html) => html.replace(/<[^>]*>/g, '').replaceAll('&lt;', '<').replaceAll('&gt;', '>').replaceAll('&quot;', '"').replaceAll('&amp;', '&');
const slugOf = (text) => text.toLowerCase().replace(/[^\p{L}\p{N} _-]/gu, '').replaceAll(' ', '-');

/// The HTML of a document. `addressOf(link)` is the address of a link's target, or null: the link then is its text alone.
export function rendered(markdown, addressOf) {
  const html = execFileSync('cmark-gfm', ['--extension', 'table', '--extension', 'autolink', '--extension', 'strikethrough'], { input: markdown, encoding: 'utf8' });
  const seen = new Map();
  return html
    .replace(/<h([1-6])>(.*?)<\/h\1>/gs, (_, level, inner) => {
      const slug = slugOf(textOf(inner)), count = seen.get(slug) ?? 0;
      seen.set(slug, count + 1);
      return `<h${level} id="${count ? `${slug}-${count}` : slug}">${inner}</h${level}>`;
    })
    .replace(/<a href="([^"]*)">(.*?)<\/a>/gs, (_, link, inner) => {
      const address = addressOf(link);
      return address === null ? inner : `<a href="${address}">${inner}</a>`;
    })
    // Options do not break after their hyphens.
    .replace(/(?<!<pre>)<code>([^<]*)<\/code>/g, (_, text) => `<code>${text.replace(/(?<![^\s])-[\w-]{1,29}(?![\w-])/g, '<span>$&</span>')}</code>`)
    // A click shows an image in its own size.
    .replace(/<img src="([^"]*)"([^>]*)>/g, (_, link, rest) => ((address) => `<a href="${address}"><img src="${address}"${rest}></a>`)(addressOf(link) ?? link))
    .replace(/<th([^>]*)><\/th>/g, '<td$1></td>')
    .replace(/<pre>/g, '<pre tabindex="0">')
    .replace(/<table>/g, '<div class="table" tabindex="0"><table>').replace(/<\/table>/g, '</table></div>');
}

/// The sections of a page, from heading to heading: { id, heading, text }.
export function sectionsOf(html) {
  return html.split(/(?=<h[1-6][ >])/).map((part) => {
    const [, id, heading] = /^<h[1-6](?: id="([^"]*)")?>(.*?)<\/h/s.exec(part) ?? [];
    return { id, heading: textOf(heading ?? ''), text: textOf(part.replace(/^<h[1-6].*?<\/h[1-6]>/s, '')).replace(/\s+/g, ' ').trim() };
  }).filter(({ heading, text }) => heading || text);
}
