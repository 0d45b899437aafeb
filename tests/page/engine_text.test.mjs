import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {test} from 'node:test';

import {namesOf, numberOf, valueOf, withoutKey, withValue} from '../../port/wasm/page/engine_text.mjs';

const kEngines = new URL('../../tools/engines/', import.meta.url);
const kText = '# top\n[crank]\nbore_mm = 86   # why\nname = V8 no.#2 # a comment\n\n[valve intake]\nvalve_g=60\n' +
              '[ valve exhaust ]# here\n  valve_g = 61\r\n';

test('a value is found in its own section, a # within a word is none', () => {
  assert.equal(numberOf(kText, 'crank', 'bore_mm'), 86);
  assert.equal(valueOf(kText, 'crank', 'name'), 'V8 no.#2');
  assert.equal(valueOf(kText, 'valve intake', 'valve_g'), '60');
  assert.equal(valueOf(kText, 'valve exhaust', 'valve_g'), '61');
  assert.equal(valueOf(kText, 'valve', 'valve_g'), null);
  assert.equal(numberOf(kText, 'crank', 'name'), null);
});

test('another value changes its line only and leaves the comment in its column', () => {
  const changed = withValue(kText, 'crank', 'bore_mm', '100.5');
  assert.equal(changed, kText.replace('bore_mm = 86   # why', 'bore_mm = 100.5 # why'));
  assert.equal(withValue(kText, 'crank', 'bore_mm', '9'), kText.replace('86   # why', '9    # why'));
  assert.equal(withValue(kText, 'valve exhaust', 'valve_g', '7'), kText.replace('= 61\r', '= 7\r'));
  assert.equal(withValue(kText, 'valve exhaust', 'no_such', '7'), kText);
});

test('every number of every sample engine can be changed and read back, and nothing else moves', () => {
  let changes = 0;
  for (const file of readdirSync(kEngines).filter((name) => name.endsWith('.ini'))) {
    const text = readFileSync(new URL(file, kEngines), 'utf8');
    let section = '';
    text.split('\n').forEach((line, i) => {
      const header = /^\[(.+?)\]/.exec(line);
      if (header) section = header[1];
      const entry = /^(\w+)\s*=\s*([-\d.]+)\s*(#.*)?$/.exec(line);
      if (!entry) return;
      const changed = withValue(text, section, entry[1], '1234.5');
      assert.equal(numberOf(changed, section, entry[1]), 1234.5);
      const after = changed.split('\n');
      assert.ok(text.split('\n').every((other, k) => k === i || other === after[k]));
      if (entry[3]) assert.ok(after[i].endsWith(entry[3]));
      ++changes;
    });
  }
  assert.ok(changes > 300, String(changes));
});

test('a key that no longer holds becomes a comment', () => {
  const text = withoutKey(kText, 'crank', 'bore_mm', 'gone');
  assert.equal(numberOf(text, 'crank', 'bore_mm'), null);
  assert.match(text, /\n# bore_mm = 86 {3}# why {2}# gone\n/);
});

test('sections by kind, in order', () => {
  assert.deepEqual(namesOf(kText, 'valve'), ['intake', 'exhaust']);
  assert.deepEqual(namesOf(kText, 'cam'), []);
});
