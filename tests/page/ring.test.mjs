import assert from 'node:assert/strict';
import {test} from 'node:test';

import {Ring} from '../../port/wasm/page/ring.mjs';

test('a ring holds the newest rows whatever blocks they came in', () => {
  let seed = 7;
  const random = (n) => (seed = (seed * 48271) % 2147483647) % n;
  for (let round = 0; round < 200; ++round) {
    const capacity = 1 + random(9);
    const ring = new Ring(2, capacity);
    const all = [];
    for (let block = 0; block < 8; ++block) {
      const count = random(2 * capacity + 3);
      const rows = [];
      for (let i = 0; i < count; ++i) rows.push(all.length + i, -(all.length + i));
      for (let i = 0; i < count; ++i) all.push(rows[2 * i]);
      ring.push(rows, count);
      const kept = all.slice(-capacity);
      assert.equal(ring.size, kept.length);
      kept.forEach((v, i) => {
        assert.equal(ring.get(i, 0), v);
        assert.equal(ring.get(i, 1), -v);
      });
    }
  }
});

test('it allocates once', () => {
  const ring = new Ring(3, 50);
  const data = ring.data;
  for (let i = 0; i < 10000; ++i) ring.push([i, i, i]);
  assert.equal(ring.data, data);
  assert.equal(data.length, 150);
  assert.ok(Number.isNaN(ring.get(50, 0)));
});
