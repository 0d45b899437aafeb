import assert from 'node:assert/strict';
import {test} from 'node:test';

import {checked, kOrders, kReports} from '../../port/wasm/page/protocol.mjs';
import {RedlineSearch} from '../../port/wasm/page/redline_search.mjs';

test('a message of the list passes as it is, any other throws', () => {
  const rate = {kind: 'rate', rate: 0.5};
  assert.equal(checked(rate, kOrders), rate);
  for (const bad of [null, {}, {kind: 'nothing'}, {kind: 'rate'}, {kind: 'rate', rate: NaN}, {kind: 'toString'},
                     {kind: 'input', base: 3, value: 1}, {kind: 'boot', bytes: [], double_bytes: null, files: []}])
    assert.throws(() => checked(bad, kOrders), TypeError);
});

test('no kind is an order and a report with other fields under one name by accident', () => {
  for (const kind of Object.keys(kOrders).filter((name) => name in kReports))
    assert.ok(['edges', 'hash'].includes(kind), kind);  // asked and answered
});

function searching(script) {
  const sent = [];
  const waiting = [];
  const module = {
    load: (path, text) => ({errors: text === 'bad' ? [{line: 1, text: 'bad'}] : []}),
    redline: () => ({errors: []}),
    redlineStep: () => script.shift() ?? {ended: true, separation_rpm: 7000},
  };
  const search = new RedlineSearch(module, (message) => sent.push(checked(message, kReports)),
                                   (call) => waiting.push(call));
  return {sent, waiting, search};
}

test('a search reports each speed and its end', () => {
  const {sent, waiting, search} = searching([{ended: false}, {ended: false}]);
  search.begin(5, 'e.ini', 'text', 'intake');
  while (waiting.length > 0) waiting.shift()();
  assert.deepEqual(sent.map((m) => [m.kind, m.id]), [['redline_begun', 5], ['redline_speed', 5],
    ['redline_speed', 5], ['redline_ended', 5]]);
});

test('a new search ends the old one, an engine that is refused begins none', () => {
  const {sent, waiting, search} = searching([]);
  search.begin(1, 'e.ini', 'text', 'intake');
  search.begin(2, 'e.ini', 'text', 'intake');
  while (waiting.length > 0) waiting.shift()();
  assert.deepEqual(sent.map((m) => [m.kind, m.id]), [['redline_begun', 1], ['redline_begun', 2],
    ['redline_ended', 2]]);
  search.begin(3, 'e.ini', 'bad', 'intake');
  assert.equal(sent.at(-1).kind, 'refused');
  assert.equal(waiting.length, 0);
});
