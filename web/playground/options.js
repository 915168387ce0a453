// The options of rendering besides the method: the rows of the program's table of options.
import { pairsOf, textOf } from './state.js';
import { element } from './report/dom.js';

/// Options for which the page has a control of its own.
const elsewhere = ['resolution', 'anti-aliasing', 'camera-azimuth-angle', 'camera-elevation-angle', 'camera-view-angle'];
const isOn = (value) => value !== undefined;

/// The options of one image.
export class OptionPanel {
  /// `rows` are those of the catalogue; `choose` gets the text of the options (state.js).
  constructor(prefix, label, rows, choose) {
    Object.assign(this, { prefix, rows: rows.filter(({ name }) => !elsewhere.includes(name)), choose, text: '' });
    this.groups = element('div', {}, [...new Set(this.rows.map(({ group }) => group))].map((group) => element('details', {}, element('summary', {}, group),
      this.rows.filter((row) => row.group === group).map((row) => element('div', { 'data-option': row.name })))));
    this.spec = element('input', { type: 'text', class: 'spec', spellcheck: 'false', 'aria-label': label, placeholder: 'shadows=hard;no-cull', onchange: () => this.choose(this.spec.value.trim()) });
    this.node = element('details', {}, element('summary', {}, 'Rendering'), this.spec, this.groups);
  }

  show(text) {
    this.text = text;
    if (document.activeElement !== this.spec) this.spec.value = text;
    for (const place of this.groups.querySelectorAll('[data-option]'))
      if (!place.contains(document.activeElement)) place.replaceChildren(this.field(place.dataset.option, this.prefix));
  }

  set(name, value) {
    const pairs = pairsOf(this.text).filter(([other]) => other !== name);
    this.choose(textOf(isOn(value) ? [...pairs, [name, value]] : pairs));
  }

  /// The field of a row with its help; null for one that is not there.
  field(name, prefix) {
    const row = this.rows.find((other) => other.name === name);
    if (!row) return null;
    const { kind, low, high, choices, meaning } = row, id = `${prefix}-${name}`, value = new Map(pairsOf(this.text)).get(name);
    const given = (event) => this.set(name, event.target.value === '' ? undefined : event.target.value);
    const fields = {
      switch: () => [element('input', { id, type: 'checkbox', checked: isOn(value), onchange: (event) => this.set(name, event.target.checked ? '' : undefined) })],
      choice: () => [element('select', { id, onchange: given }, ['', ...choices].map((text) => element('option', { value: text, selected: text === (value ?? '') }, text || 'default')))],
      text: () => [element('input', { id, type: 'text', spellcheck: 'false', list: choices.length ? `${id}-names` : undefined, value: value ?? '', placeholder: row.value, onchange: given }),
        ...choices.length ? [element('datalist', { id: `${id}-names` }, choices.map((text) => element('option', { value: text })))] : []],
    };
    const number = () => [element('input', { id, type: 'number', min: low, max: high, step: kind === 'whole' ? 1 : 'any', value: value ?? '', placeholder: row.value, onchange: given })];
    return element('div', { class: isOn(value) ? 'field changed' : 'field' }, element('label', { for: id }, name), ...(fields[kind] ?? number)(), element('small', {}, meaning));
  }
}
