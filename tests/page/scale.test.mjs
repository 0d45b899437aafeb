import assert from 'node:assert/strict';
import {test} from 'node:test';

import {angleTicks, extentOf, mapping, steadyRange, ticksOf} from '../../port/wasm/page/scale.mjs';

test('ticks are round, rising, inside and at most as many as asked and one', () => {
  for (const [low, high] of [[0, 1], [-238, 678], [0.0001, 0.00093], [-1e7, 3e7], [5999, 6001], [-0.3, -0.1]]) {
    for (const most of [3, 5, 8]) {
      const ticks = ticksOf(low, high, most);
      assert.ok(ticks.length >= 1 && ticks.length <= most + 1, `${low} ${high} ${most}: ${ticks}`);
      ticks.forEach((t, i) => {
        assert.ok(t >= low - 1e-9 * Math.abs(low) && t <= high + 1e-9 * Math.abs(high));
        if (i > 0) assert.ok(t > ticks[i - 1]);
      });
    }
  }
  assert.deepEqual(ticksOf(-0.3, 0.3, 6), [-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3]);
  assert.deepEqual(ticksOf(1, 1, 5), []);
  assert.deepEqual(ticksOf(0, Infinity, 5), []);
  assert.deepEqual(angleTicks(0, 720, 8), [0, 90, 180, 270, 360, 450, 540, 630, 720]);
  assert.deepEqual(angleTicks(0, 720, 4), [0, 180, 360, 540, 720]);
});

const curveOf = (...rows) => ({rows, n: 1, y: (list, at) => list[at]});

test('a range holds what it shows and stays while that fits', () => {
  const range = steadyRange(extentOf([curveOf(1, NaN, 7.3), curveOf(-0.2, Infinity)], 'y'), null);
  assert.ok(range.low <= -0.2 && range.high >= 7.3);
  assert.equal(steadyRange({low: -0.1, high: 7}, range), range);
  assert.notEqual(steadyRange({low: 0, high: 9}, range), range);
  assert.notEqual(steadyRange({low: 0, high: 0.5}, range), range);  // a third of it is not filled
});

test('what is little below zero has no range of its own where it is said', () => {
  assert.equal(steadyRange({low: -0.1, high: 9.5}, null, {below: 0.03}).low, 0);
  assert.ok(steadyRange({low: -0.4, high: 9.5}, null, {below: 0.03}).low <= -0.4);
  assert.equal(steadyRange({low: 2, high: 9.5}, null, {below: 0.03}).low, 0);
});

test('nothing at all has a range of some width', () => {
  for (const zero of [true, false]) {
    const range = steadyRange(extentOf([curveOf()], 'y'), null, {zero, least_span: 1});
    assert.ok(range.high > range.low);
    const constant = steadyRange({low: 5, high: 5}, null, {zero: false, least_span: 1});
    assert.ok(constant.low <= 5 && constant.high >= 5 && constant.high > constant.low);
  }
});

test('a mapping goes there and back', () => {
  const map = mapping({low: 0, high: 720}, {low: 40, high: 400});
  assert.equal(map(360), 220);
  assert.equal(map.back(map(123)), 123);
});
