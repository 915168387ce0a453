// Elements of the document.

function build(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== undefined && value !== null) node.setAttribute(name, value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

/// element('button', { class: 'x', onclick: f }, 'text', child): an attribute that is false or undefined is left out; arrays of children may be nested.
export const element = (name, attributes = {}, ...children) => build(document.createElement(name), attributes, children);
export const drawing = (name, attributes = {}, ...children) =>
  build(document.createElementNS('http://www.w3.org/2000/svg', name), attributes, children);

/// The name of a button for screen readers: its text, if that has words.
export const nameOf = (text, label) => (/\w/.test(text) ? undefined : label);

/// A row of buttons of which one is pressed. `options` are [value, text, key]; returns { node, show(value, hidden) }.
export function choice(label, options, choose) {
  const buttons = new Map(options.map(([value, text, key]) => [value, element('button', {
    type: 'button', title: key && `${text} (key ${key})`, 'aria-keyshortcuts': key, 'data-value': value, onclick: () => choose(value),
  }, text)]));
  const show = (chosen, hidden = []) => {
    for (const [value, button] of buttons) {
      button.setAttribute('aria-pressed', value === chosen);
      button.hidden = hidden.includes(value);
    }
  };
  return { node: element('div', { class: 'choice', role: 'group', 'aria-label': label }, [...buttons.values()]), show };
}

/// A list to choose from. `options` are texts; `choose` gets the index.
export function list(label, options, choose) {
  const select = element('select', { 'aria-label': label, onchange: () => choose(select.selectedIndex) },
    options.map((text) => element('option', {}, text)));
  return select;
}
