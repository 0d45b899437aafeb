// Elements out of words: text is always text, never markup.

/// element('p', {class: 'note', 'aria-live': 'polite'}, 'words', another); a property of false or null is left out.
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === false || value === null || value === undefined) continue;
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children.map((child) => child instanceof Node ? child : String(child)));
  return made;
}

export function byId(id) { return document.getElementById(id); }

export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/// A slider with its number beside it, one value: {node, set(value), get(), range}. change(value) is called for each
/// input of a hand, never by set().
export function slider({label, unit = '', min, max, step, value, key = '', change}) {
  const id = `c${++slider.made}`;
  const range = element('input', {type: 'range', id, min, max, step, value});
  const number = element('input', {type: 'number', min, max, step: 'any', value, 'aria-label': `${label}, ${unit}`});
  const node = element('div', {class: 'slider'}, element('label', {for: id, title: key ? `key ${key}` : null}, label),
                       range, element('span', {class: 'value'}, number, element('span', {class: 'unit'}, unit)));
  range.addEventListener('input', () => {
    number.value = range.value;
    change(Number(range.value));
  });
  number.addEventListener('change', () => {
    const typed = Math.min(Number(max), Math.max(Number(min), Number(number.value)));
    if (number.value === '' || !Number.isFinite(typed)) return;
    number.value = String(typed);
    range.value = String(typed);
    change(typed);
  });
  const set = (to) => {
    range.value = String(to);
    if (document.activeElement !== number) number.value = String(to);
  };
  return {node, set, get: () => Number(number.value), range};
}
slider.made = 0;

/// Radio buttons of one question: {node, set(value)}.
export function choice({legend, options, value, change}) {
  const name = `c${++slider.made}`;
  const inputs = options.map(([of]) => element('input', {
    type: 'radio', name, value: of, checked: of === value, onchange: () => change(of)}));
  const node = element('fieldset', {class: 'choice'}, element('legend', {}, legend),
                       ...options.map(([, words], i) => element('label', {}, inputs[i], words)));
  const set = (to) => inputs.forEach((input) => { input.checked = input.value === to; });
  return {node, set, inputs};
}

export function check({label, value = false, change}) {
  const input = element('input', {type: 'checkbox', checked: value});
  input.addEventListener('change', () => change(input.checked));
  return {node: element('label', {class: 'check'}, input, label), input};
}

/// A file for the reader's disk.
export function offer(name, type, content) {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], {type}));
  const link = element('a', {href: url, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
