// The choice of a row of a catalogue and of its parameters, as a text such as msaa:n=4.
import { element } from './report/dom.js';

/// { name, given } of name:key=value,key=value.
export function readSpec(text) {
  const colon = text.indexOf(':'), name = colon < 0 ? text : text.slice(0, colon);
  const items = colon < 0 ? [] : text.slice(colon + 1).split(',').filter(Boolean);
  return { name, given: new Map(items.map((item) => [item.slice(0, item.indexOf('=')), item.slice(item.indexOf('=') + 1)])) };
}

export function writeSpec({ name, given }) {
  const items = [...given].map(([key, value]) => `${key}=${value}`);
  return items.length ? `${name}:${items.join(',')}` : name;
}

/// The default value of a parameter as its text.
export const defaultOf = ({ names, value }) => (names.length ? names[value] : String(value));

function numberFields(param, id, value, set) {
  const { low, high, decimals } = param, isWhole = decimals === 0;
  const step = isWhole ? 1 : decimals > 0 ? 10 ** -decimals : 'any';
  const number = element('input', { id, type: 'number', min: low, max: high, step, value, onchange: () => set(number.value) });
  if (high - low > 100 * (isWhole ? 1 : 100) || high - low <= 0) return [number];
  const range = element('input', { type: 'range', min: low, max: high, step: isWhole ? 1 : (high - low) / 200, value, 'aria-label': param.name,
    oninput: () => { number.value = String(+Number(range.value).toPrecision(4)); set(number.value); } });
  return [number, range];
}

/// One parameter with its help. `set` gets its value as a text.
export function makeField(param, prefix, value, set) {
  const { name, meaning, names, choices } = param, id = `${prefix}-${name}`, options = names.length ? names : choices.map(String);
  const fields = options.length
    ? [element('select', { id, onchange: (event) => set(event.target.value) }, options.map((text) => element('option', { selected: text === value }, text)))]
    : numberFields(param, id, value, set);
  return element('div', { class: value === defaultOf(param) ? 'field' : 'field changed' }, element('label', { for: id }, name), ...fields, element('small', {}, meaning));
}

/// A list of rows in groups and the fields of the chosen one.
export class Chooser {
  /// `groups` are [label, rows]; `choose` gets the text.
  constructor(prefix, label, groups, choose) {
    Object.assign(this, { prefix, choose, rows: groups.flatMap(([, rows]) => rows) });
    this.list = element('select', { 'aria-label': label, onchange: () => choose(this.list.value) }, groups.map(([name, rows]) =>
      (groups.length < 2 ? rows.map((row) => element('option', {}, row.name)) : element('optgroup', { label: name }, rows.map((row) => element('option', {}, row.name))))));
    this.spec = element('input', { type: 'text', class: 'spec', spellcheck: 'false', 'aria-label': `${label} with its parameters`, onchange: () => choose(this.spec.value.trim()) });
    this.summary = element('p');
    this.fields = element('div');
    this.details = element('details', {}, element('summary', {}, 'Parameters'), this.fields);
    this.node = element('div', {}, this.list, this.spec, this.summary, this.details);
  }

  show(text) {
    const { name, given } = readSpec(text), row = this.rows.find((r) => r.name === name);
    this.list.value = row ? name : '';
    if (document.activeElement !== this.spec) this.spec.value = text;
    this.summary.textContent = row?.summary ?? '';
    this.details.hidden = !row?.params.length;
    if (this.shown === name && this.fields.contains(document.activeElement)) return this.mark(row, given);
    this.shown = name;
    this.fields.replaceChildren(...(row?.params ?? []).map((param) => makeField(param, this.prefix, given.get(param.name) ?? defaultOf(param), (value) => this.set(param, value))));
    return undefined;
  }

  mark(row, given) {
    [...this.fields.children].forEach((field, i) => field.classList.toggle('changed', given.has(row.params[i].name)));
  }

  /// A value that is the default is left out of the text.
  set(param, value) {
    const spec = readSpec(this.spec.value.trim());
    if (value === defaultOf(param) || value === '') spec.given.delete(param.name);
    else spec.given.set(param.name, value);
    this.spec.value = writeSpec(spec);
    this.choose(this.spec.value);
  }
}
