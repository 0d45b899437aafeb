import assert from 'node:assert/strict';
import {test} from 'node:test';

import {betweenAngles, displacementOf, poseOf, strokeName, volumeOf} from '../../port/wasm/page/mechanism.mjs';

const kDiesel = {crank_radius_m: 0.0575, rod_length_m: 0.21, pin_offset_m: 0.003, bore_m: 0.095,
                 compression_ratio: 19};

test('the rod keeps its length and the piston its axis at every angle', () => {
  for (let deg = 0; deg < 720; deg += 7) {
    const {pin, piston} = poseOf(kDiesel, deg * Math.PI / 180);
    assert.ok(Math.abs(Math.hypot(pin.x_m - piston.x_m, pin.y_m - piston.y_m) - 0.21) < 1e-15);
    assert.equal(piston.x_m, 0.003);
    assert.ok(Math.abs(Math.hypot(pin.x_m, pin.y_m) - 0.0575) < 1e-15);
  }
});

test('displacement is that of the 495 design sheet: 29.4 mm at 60 deg without offset', () => {
  const centred = {...kDiesel, pin_offset_m: 0};
  const r = 57.5;
  const lambda = 57.5 / 210;
  // the sheet's own series, docs/model.md: r [(1 - cos a) + lambda/4 (1 - cos 2a)], right to lambda^3
  const series_mm = r * ((1 - 0.5) + lambda / 4 * (1 + 0.5));
  assert.ok(Math.abs(displacementOf(centred, Math.PI / 3) * 1e3 - series_mm) < 0.5 * r * lambda ** 3);
  assert.ok(Math.abs(displacementOf(centred, Math.PI) - 0.115) < 1e-15);
});

test('volume goes from clearance to clearance and swept in the compression ratio', () => {
  const centred = {...kDiesel, pin_offset_m: 0};
  assert.ok(Math.abs(volumeOf(centred, Math.PI) / volumeOf(centred, 0) - 19) < 1e-9);
  const swept_m3 = volumeOf(centred, Math.PI) - volumeOf(centred, 0);
  assert.ok(Math.abs(swept_m3 - Math.PI / 4 * 0.095 ** 2 * 0.115) < 1e-12);
});

test('angles between two ticks go the short way across 720', () => {
  assert.ok(Math.abs(betweenAngles(719, 1, 0.25, 720) - 719.5) < 1e-9);
  assert.ok(Math.abs(betweenAngles(719, 1, 0.75, 720) - 0.5) < 1e-9);
  assert.ok(Math.abs(betweenAngles(3, 1, 0.5, 720) - 2) < 1e-9);
});

test('strokes begin at their dead centres', () => {
  assert.deepEqual([0, 179.9, 180, 360, 540, 720, -1].map(strokeName),
                   ['power', 'power', 'exhaust', 'intake', 'compression', 'power', 'compression']);
});
