// Tables that are sorted by their heads.
import { element } from './dom.js';

/// The number at the start of a cell, for sorting; null for a text.
export function numberOf(cell) {
  const match = /^[\s*]*([+±]?)([−-]?\d[\d,.]*(?:e[+-]?\d+)?)/i.exec(cell);
  if (match) return Number(match[2].replace('−', '-').replaceAll(',', ''));
  return /^[+]?(inf|∞|same)$/.test(cell.trim()) ? Infinity : /^[-−](inf|∞)$/.test(cell.trim()) ? -Infinity : null;
}

/// `go(target)` is called when a row with a target is chosen.
export function makeTable({ title, head, rows, targets }, go) {
  const isNumeric = head.map((_, column) => column > 0 && rows.filter((row) => numberOf(row[column]) !== null).length * 2 > rows.length);
  const body = element('tbody'), lines = rows.map((row, i) => {
    const target = targets[i] ?? null;
    const cells = row.map((cell, column) => {
      const content = column === 0 && target ? element('button', { type: 'button', class: 'link', onclick: () => go(target) }, cell) : cell;
      return element(column === 0 ? 'th' : 'td', { scope: column === 0 && 'row', class: isNumeric[column] && 'number' }, content,
        column === 0 && target?.is_on_front ? element('span', { class: 'front', title: 'on the Pareto front' }, '●', element('span', { class: 'unseen' }, ' on the Pareto front')) : null);
    });
    return { row, target, node: element('tr', { class: target?.failed && 'failed', 'data-target': target && JSON.stringify([target.scene ?? null, target.image ?? null, target.frame ?? null]) }, cells) };
  });
  body.append(...lines.map((line) => line.node));

  let sorted = { column: -1, direction: 1 };
  const heads = head.map((text, column) => element('th', { scope: 'col', class: isNumeric[column] && 'number' },
    text ? element('button', { type: 'button', onclick: () => sort(column) }, text) : null));
  function sort(column) {
    sorted = { column, direction: sorted.column === column ? -sorted.direction : 1 };
    const key = (line) => (isNumeric[column] ? numberOf(line.row[column]) : line.row[column]);
    const compare = isNumeric[column] ? (a, b) => a - b || 0 : (a, b) => a.localeCompare(b, 'en', { numeric: true });
    // Cells without a number are last in both directions.
    const order = [...lines].sort((a, b) => {
      const x = key(a), y = key(b);
      return x === null || y === null ? (x === null) - (y === null) : sorted.direction * (x === y ? 0 : compare(x, y));
    });
    body.append(...order.map((line) => line.node));
    heads.forEach((node, i) => (i === column ? node.setAttribute('aria-sort', sorted.direction > 0 ? 'ascending' : 'descending') : node.removeAttribute('aria-sort')));
  }
  return element('div', { class: 'table', tabindex: 0, role: 'region', 'aria-label': title || 'Table' },
    element('table', {}, title ? element('caption', {}, title) : null, element('thead', {}, element('tr', {}, heads)), body));
}
