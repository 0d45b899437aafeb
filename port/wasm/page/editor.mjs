// The engine file in an editor: line numbers at its left, errors beside their lines and in a list below.

import {element} from './dom.mjs';

const kWait_ms = 250;  // after the last key before the text is read

export class Editor {
  /// root: an empty element; typed(text) is called when a hand has changed the text.
  constructor(root, typed) {
    this.numbers = element('pre', {class: 'line-numbers', 'aria-hidden': 'true'});
    this.area = element('textarea', {spellcheck: 'false', autocapitalize: 'off', autocomplete: 'off', wrap: 'off',
                                     'aria-label': 'Engine file', 'aria-describedby': 'editor-problems', rows: 28});
    this.flags = element('div', {class: 'flags', 'aria-hidden': 'true'});
    root.append(element('div', {class: 'lines'}, this.numbers),
                element('div', {class: 'text'}, this.area, this.flags));
    this.problems = [];
    let timer = 0;
    this.area.addEventListener('input', () => {
      this.#number();
      clearTimeout(timer);
      timer = setTimeout(() => typed(this.area.value), kWait_ms);
    });
    this.area.addEventListener('scroll', () => this.#place());
    new ResizeObserver(() => this.#place()).observe(this.area);
  }

  setText(text) {
    if (this.area.value === text) return;
    const {scrollTop, selectionStart, selectionEnd} = this.area;
    this.area.value = text;
    this.area.setSelectionRange(selectionStart, selectionEnd);
    this.area.scrollTop = scrollTop;
    this.#number();
  }

  /// problems: [{line, text, kind: 'error' | 'warning'}]; line 0: of the whole file.
  setProblems(problems) {
    this.problems = problems.filter(({line}) => line > 0);
    this.flags.replaceChildren(...this.problems.map(({text, kind}) => element('span', {class: kind}, short(text))));
    this.#number();
    this.#place();
  }

  goTo(line) {
    const lines = this.area.value.split('\n');
    const start = lines.slice(0, line - 1).reduce((sum, l) => sum + l.length + 1, 0);
    this.area.focus();
    this.area.setSelectionRange(start, start + (lines[line - 1]?.length ?? 0));
    this.area.scrollTop = (line - 4) * this.#lineHeight();
  }

  #number() {
    const bad = new Set(this.problems.map(({line}) => line));
    const count = this.area.value.split('\n').length;
    const key = `${count}:${[...bad].join()}`;
    if (key === this.numbered) return;
    this.numbered = key;
    this.numbers.replaceChildren(...Array.from({length: count}, (_, i) => bad.has(i + 1) ?
      element('b', {}, `${i + 1}\n`) : `${i + 1}\n`));
  }

  #lineHeight() { return parseFloat(getComputedStyle(this.area).lineHeight); }

  #place() {
    const height = this.#lineHeight();
    const pad = parseFloat(getComputedStyle(this.area).paddingTop);
    this.numbers.style.transform = `translateY(${-this.area.scrollTop}px)`;
    const room = this.area.clientHeight;
    [...this.flags.children].forEach((flag, i) => {
      const top = pad + (this.problems[i].line - 1) * height - this.area.scrollTop;
      flag.hidden = top < 0 || top > room - height;
      flag.style.top = `${top}px`;
    });
  }
}

/// Without "FILE:12: ", which the place says.
function short(text) { return text.replace(/^[^:]*:\d+: /, ''); }
