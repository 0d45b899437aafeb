import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {test} from 'node:test';

import {joined, kPage} from './join.mjs';

const kModules = readdirSync(kPage).filter((name) => name.endsWith('.mjs'));
const read = (name) => readFileSync(new URL(name, kPage), 'utf8');

test('a module is short, and no line long', () => {
  for (const name of kModules) {
    const lines = read(name).split('\n');
    assert.ok(lines.length <= 300, `${name}: ${lines.length} lines`);
    lines.forEach((line, i) => assert.ok(line.length <= 120, `${name}:${i + 1}: ${line.length} characters`));
  }
});

test('nothing makes markup or code out of text', () => {
  const forbidden = ['innerHTML', 'outerHTML', 'insertAdjacentHTML', 'document.write', ' eval(', 'new Function',
                     'DOMParser', 'createContextualFragment', 'setHTML'];
  for (const name of kModules)
    for (const words of forbidden) assert.ok(!read(name).includes(words), `${name}: ${words}`);
  assert.doesNotMatch(read('page.html'), /\son\w+=|javascript:/);
});

test('modules keep to what the joiner reads: imports at the head, each export before its declaration', () => {
  for (const name of kModules) {
    const rest = read(name)
      .replace(/^import\s*\{[\w\s,]+\}\s*from\s*'(\.\/|\.\.\/)[\w.-]+';$/gm, '')
      .replace(/^export (async )?(function\*?|class|const) \w+/gm, '');
    assert.doesNotMatch(rest, /^\s*(import|export)\b/m, name);
  }
});

test('every module is reached from the page or its worker, and both join', () => {
  const text = joined('main.mjs') + joined('worker.mjs');
  for (const name of kModules) assert.ok(text.includes(`m_${name.replace(/\W/g, '_')} =`), name);
  assert.doesNotThrow(() => new Function(joined('main.mjs')));
  assert.doesNotThrow(() => new Function(joined('worker.mjs')));
});

test('what the script asks for by id is in the page, once', () => {
  const page = read('page.html');
  const ids = kModules.flatMap((name) => [...read(name).matchAll(/(?:byId|Block)\('([\w-]+)'\)/g)].map((m) => m[1]));
  assert.ok(ids.length > 40, String(ids.length));
  for (const id of new Set(ids)) assert.equal(page.split(`id="${id}"`).length, 2, id);
});
