// The lines of tests/options/rows.txt: a value of each row of the table of options that is not its default.
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = path.join(path.dirname(path.dirname(path.dirname(fileURLToPath(import.meta.url)))), 'tests/options');

const pairOf = (text, at) => {
  const end = text.indexOf(at);
  return end < 0 ? [text, ''] : [text.slice(0, end), text.slice(end + 1)];
};

/// { name, model, output, options, plain }: the options, [NAME, VALUE], or [NAME, ''] of a switch, with the row and without it;
/// `acts` if the bytes differ.
export function optionRows(size = '48,40') {
  const lines = fs.readFileSync(path.join(folder, 'rows.txt'), 'utf8').split('\n').filter((line) => line && !line.startsWith('#'));
  return lines.map((line) => {
    const [option, model, output, others] = line.split('|').map((part) => part.trim());
    const row = pairOf(option, ' '), words = others.split(/\s+/).filter(Boolean), more = words.filter((word) => word !== '=').map((word) => pairOf(word, '='));
    const sized = row[0] === 'resolution' ? [] : [['resolution', size]];
    return { name: row[0], model, output, options: [...sized, ...more, row], acts: !words.includes('=') };
  });
}

/// Copies the models and images of the rows.
export const copyOptionFiles = (to) => fs.cpSync(folder, to, { recursive: true });
export const optionFiles = () => fs.readdirSync(folder).filter((name) => !name.endsWith('.txt')).map((name) => ({ path: name, bytes: fs.readFileSync(path.join(folder, name)) }));
