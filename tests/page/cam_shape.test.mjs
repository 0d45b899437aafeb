import assert from 'node:assert/strict';
import {test} from 'node:test';

import {camOutline, polarOutline, valveRow} from '../../port/wasm/page/cam_shape.mjs';

test('a flat follower at any angle rests on the outline at base circle and lift', () => {
  const n = 720;
  const lift = Float64Array.from({length: n}, (_, i) => 0.0045 * (1 + Math.cos(2 * Math.PI * i / n)));
  const outline = camOutline(lift, 0.018);
  for (let k = 0; k < n; k += 40) {  // by brute force: the farthest point along the follower's normal
    const t = 2 * Math.PI * k / n;
    let farthest = 0;
    for (let i = 0; i < n; ++i)
      farthest = Math.max(farthest, outline[2 * i] * Math.cos(t) + outline[2 * i + 1] * Math.sin(t));
    assert.ok(Math.abs(farthest - (0.018 + lift[k])) < 1e-6, `at ${k}: ${farthest}`);
  }
});

test('no lift is a circle', () => {
  const outline = camOutline(new Float64Array(36), 0.02);
  for (let i = 0; i < 36; ++i)
    assert.ok(Math.abs(Math.hypot(outline[2 * i], outline[2 * i + 1]) - 0.02) < 1e-15);
});

test('a lift that no flat follower could follow is drawn along the radius', () => {
  const outline = polarOutline([0.01, 0, 0, 0], 0.02);
  assert.ok(Math.abs(outline[0] - 0.03) < 1e-15 && outline[1] === 0);
  assert.ok(Math.abs(outline[3] - 0.02) < 1e-15);
});

test('valves stand in the bore and beside each other, to scale where they fit', () => {
  for (const heads of [[0.04], [0.033, 0.028], [0.033, 0.033, 0.028, 0.028]]) {
    const row = valveRow(heads, 0.086);
    row.forEach((v, i) => {
      assert.ok(Math.abs(v.centre_m) + v.diameter_m / 2 <= 0.043);
      if (i > 0) assert.ok(v.centre_m - v.diameter_m / 2 > row[i - 1].centre_m + row[i - 1].diameter_m / 2);
    });
    if (heads.length < 3) assert.deepEqual(row.map((v) => v.diameter_m), heads);
  }
});
