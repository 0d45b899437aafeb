import assert from 'node:assert/strict';
import {test} from 'node:test';

import {angleAt, CycleTrace, kMostRows, samplingOf} from '../../port/wasm/page/cycle_trace.mjs';
import {Runner} from '../../port/wasm/page/runner.mjs';
import {watchedOf} from '../../port/wasm/page/watched.mjs';
import {FakeModule} from './fake_module.mjs';

const kSettings = {tick_us: 100, in_double: false, free: false, speed_rpm: 3000, crank_deg: 0};

function started(settings = kSettings) {
  const clock = {ms: 0};
  const runner = new Runner(new FakeModule(), () => clock.ms);
  assert.deepEqual(runner.open('e.ini', 'good', settings).errors, []);
  return {clock, runner};
}

test('at real time a second of frames is a second of the model', () => {
  const {clock, runner} = started();
  for (let i = 0; i <= 60; ++i, clock.ms = i * 1000 / 60) runner.frame();
  assert.ok(Math.abs(runner.now[0] - 1) <= 2e-4, String(runner.now[0]));
});

test('a whole cycle has a row for each tick, from dead centre on, and its edges by angle', () => {
  const {clock, runner} = started();
  const cycles = [];
  for (; clock.ms < 500; clock.ms += 5) {
    const {cycle} = runner.frame();
    if (cycle !== null) cycles.push(cycle);
  }
  assert.ok(cycles.length >= 4, String(cycles.length));
  for (const {rows, edges, results} of cycles) {
    const count = rows.length / runner.columns.length;  // 3000 rpm: 40 ms of 100 us; one may fall on 720 itself
    assert.ok(count >= 399 && count <= 401, String(count));
    for (let r = 1; r < count; ++r) {
      const n = runner.columns.length;
      assert.ok(Math.abs(rows[r * n + 1] - rows[(r - 1) * n + 1] - 1.8) < 1e-6);
    }
    assert.equal(results[0], 42);
    assert.ok(edges.length / 3 >= 7 && edges.length / 3 <= 9, String(edges.length / 3));
    for (let i = 0; i < edges.length; i += 3) {
      const deg = edges[i];
      assert.ok(Math.abs(deg / 90 - Math.round(deg / 90)) < 1e-3, String(deg));
    }
  }
});

test('a pause stops time, a tick is one tick, and the picture stands at it', () => {
  const {clock, runner} = started();
  runner.frame();
  runner.setPaused(true);
  const [time_s] = runner.now;
  clock.ms = 5000;
  assert.equal(runner.frame().now[0], time_s);
  runner.stepTicks(1);
  const frame = runner.frame();
  assert.ok(Math.abs(frame.now[0] - time_s - 1e-4) < 1e-12);
  assert.equal(frame.before[1], frame.now[1]);
  runner.setPaused(false);
  runner.frame();
  clock.ms = 5010;
  assert.ok(Math.abs(runner.frame().now[0] - time_s - 0.0101) < 1.1e-4);
});

test('one cycle goes to the first tick behind the dead centre', () => {
  const {runner} = started();
  runner.setPaused(true);
  runner.stepCycle();
  assert.equal(runner.module.cycles(), 1);
  assert.ok(runner.now[1] < 1.8);
  runner.stepCycle();
  assert.notEqual(runner.frame().cycle, null);
});

test('what is refused leaves the engine that runs', () => {
  const {runner} = started();
  runner.stepTicks(10);
  assert.equal(runner.open('e.ini', 'a\nb\nbad', kSettings).errors[0].line, 3);
  assert.equal(runner.start({...kSettings, tick_us: 0}).errors.length, 1);
  runner.stepTicks(1);
  assert.equal(runner.module.ticks, 11);
});

test('a changed engine goes on at its angle with the inputs that were set', () => {
  const {runner} = started();
  runner.setInput('fuel_kg', 3e-5);
  runner.stepTicks(100);
  const deg = runner.now[1];
  runner.open('e.ini', 'good too', {...kSettings, crank_deg: null});
  assert.equal(runner.module.start_deg, deg);
  assert.deepEqual([...runner.module.input.subarray(2, 4)], [3e-5, 3e-5]);
});

test('nothing grows: minutes of model time in buffers of fixed size', () => {
  const {runner} = started({...kSettings, tick_us: 2000});
  const {buffer} = runner.trace.rows;
  const edges = runner.edges.data;
  for (let i = 0; i < 400; ++i) runner.stepTicks(256);
  assert.ok(runner.now[0] > 200);
  assert.equal(runner.trace.rows.buffer, buffer);
  assert.equal(runner.edges.data, edges);
  assert.ok(runner.allEdges().rows.length <= 3 * 16384);
});

test('a trace gives each row out once, and says where it begins anew', () => {
  const trace = new CycleTrace(2);
  const ended = [];
  const push = (...degs) => trace.push(Float64Array.from(degs.flatMap((deg, i) => [i, deg])), 1,
                                       (rows) => ended.push(rows.length / 2));
  push(300, 500, 700);
  push(10, 200);
  assert.deepEqual(trace.takeNew(), {rows: Float64Array.of(0, 10, 1, 200), restarted: true});
  push(400);
  assert.deepEqual(trace.takeNew(), {rows: Float64Array.of(0, 400), restarted: false});
  push(600, 5);
  assert.deepEqual(ended, [4]);  // the first, begun at 300, was not whole
  push(715);  // backwards over the dead centre
  push(2);
  assert.deepEqual(ended, [4]);
});

test('a crank that stands fills no more than the rows that there are', () => {
  const trace = new CycleTrace(2);
  for (let i = 0; i < 3 * kMostRows; ++i) trace.push(Float64Array.of(i, 17), 1, assert.fail);
  assert.ok(trace.count <= kMostRows);
});

test('samples of a cycle fit at any speed and tick', () => {
  for (const rpm of [30, 300, 3000, 15000]) {
    for (const tick_s of [1e-6, 5e-5, 2e-3]) {
      const speed_rad_s = rpm * Math.PI / 30;
      const every = samplingOf(speed_rad_s, tick_s);
      assert.ok(Number.isInteger(every) && 4 * Math.PI / speed_rad_s / tick_s / every <= kMostRows);
    }
  }
});

test('an edge between two samples has the angle between theirs, across 720 too', () => {
  const samples = Float64Array.of(0, 716, 1, 718, 2, 2);
  assert.equal(angleAt(samples, 2, 0.5), 717);
  assert.equal(angleAt(samples, 2, 1.25), 719);
  assert.equal(angleAt(samples, 2, 1.75), 1);
});

test('what is watched is there, of one cylinder, with the pressure of all', () => {
  const names = ['speed_rad_s', 'cylinder[1].pressure_Pa', 'cylinder[2].pressure_Pa', 'cylinder[2].torque_Nm',
                 'valve[1,1].lift_m', 'valve[1,2].lift_m', 'valve_forces[1,2].regime', 'valve_forces[1,2].other'];
  assert.deepEqual(watchedOf(names, 2), ['speed_rad_s', 'cylinder[1].pressure_Pa', 'cylinder[2].pressure_Pa',
    'cylinder[2].torque_Nm', 'valve[1,2].lift_m', 'valve_forces[1,2].regime']);
});
