import assert from 'node:assert/strict';
import {test} from 'node:test';

import {kSlowest, Pacing, rateName, rateOfSlider, sliderOfRate} from '../../port/wasm/page/pacing.mjs';

test('over a minute of uneven wake-ups the ticks are those of the clock times the rate', () => {
  for (const rate of [1, 0.5, 1 / 37, kSlowest]) {
    const pacing = new Pacing(50e-6);
    pacing.setRate(rate);
    let now_ms = 1000;
    let ticks = pacing.due(now_ms);
    for (let i = 0; now_ms < 61000; ++i) {
      now_ms = Math.min(61000, now_ms + 3 + (i * 7919) % 23);
      ticks += pacing.due(now_ms);
    }
    assert.ok(Math.abs(ticks - 60 * rate / 50e-6) <= 1, `rate ${rate}: ${ticks}`);
    assert.equal(pacing.dropped_ms, 0);
  }
});

test('a page that was hidden for an hour does not catch up', () => {
  const pacing = new Pacing(1e-4);
  pacing.due(0);
  assert.equal(pacing.due(3600e3), 1000);
  assert.equal(pacing.dropped_ms, 3600e3 - 100);
});

test('a pause takes no time', () => {
  const pacing = new Pacing(1e-4);
  pacing.due(0);
  pacing.pause();
  assert.equal(pacing.due(5000), 0);
  assert.equal(pacing.due(5010), 100);
});

test('work that the machine cannot do is given up, not stored', () => {
  const pacing = new Pacing(1e-5);
  pacing.due(0);
  for (let t = 10; t <= 10000; t += 10) {
    pacing.due(t, 100);  // a tenth of what is due
    pacing.giveUp();
    assert.ok(pacing.owed <= 10000);
  }
  assert.ok(pacing.dropped_ms > 8500);
});

test('between ticks the fraction rises to one', () => {
  const pacing = new Pacing(1e-4, kSlowest);
  pacing.due(0);
  pacing.due(100);
  assert.ok(Math.abs(pacing.fraction(500) - 0.5) < 1e-9);
  assert.equal(pacing.fraction(5000), 1);
});

test('the slider spans 1/10 000 to real time and back', () => {
  assert.ok(Math.abs(rateOfSlider(0) - 1e-4) < 1e-18);
  assert.equal(rateOfSlider(100), 1);
  for (const place of [0, 13, 50, 100]) assert.ok(Math.abs(sliderOfRate(rateOfSlider(place)) - place) < 1e-9);
  assert.deepEqual([1, 0.5, 1 / 40, 1e-4].map(rateName), ['real time', '1/2', '1/40', '1/10000']);
});
