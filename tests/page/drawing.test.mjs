import assert from 'node:assert/strict';
import {test} from 'node:test';

import {barsOf, stepsOf} from '../../port/wasm/page/lanes.mjs';
import {poseOf} from '../../port/wasm/page/mechanism.mjs';
import {camTurn_rad, layoutOf, liftFromLobe, ratioOf} from '../../port/wasm/page/picture_layout.mjs';
import {Rows} from '../../port/wasm/page/rows.mjs';
import {FakeModule} from './fake_module.mjs';

/// A lobe that is wide enough for a flat follower.
function facts() {
  const module = new FakeModule();
  module.load('fake.ini', '[cam intake]\nhalf_angle_deg = 80');
  return module.facts();
}

test('the crown comes as near to the head as the compression ratio says', () => {
  const layout = layoutOf(facts());
  const crown_m = poseOf(layout.crank, 0).piston.y_m + layout.crown_m;
  assert.ok(Math.abs((0.086 + layout.face_m - crown_m) / (layout.face_m - crown_m) - 10) < 1e-9);
});

test('a bucket rests on its cam at every angle: the outline reaches just to it', () => {
  const layout = layoutOf(facts());
  const [{cam, outline, train, tip_m, bucket_m}] = layout.trains;
  const points = outline(1);
  const lift_m = liftFromLobe(train);
  for (const own_deg of [0, 400, 430, 459, 460, 480, 560]) {
    const turn_rad = cam.contact_rad - camTurn_rad(train, own_deg);
    let lowest_m = Infinity;
    for (let i = 0; i < points.length; i += 2)
      lowest_m = Math.min(lowest_m, cam.y_m + Math.sin(turn_rad) * points[i] + Math.cos(turn_rad) * points[i + 1]);
    const cam_deg = (own_deg - 460) / 2;
    const wanted_m = lift_m[(Math.round(cam_deg) + 360) % 360];
    if (!Number.isInteger(cam_deg)) continue;
    assert.ok(Math.abs(lowest_m - (tip_m + bucket_m - wanted_m)) < 2e-6,
              `${own_deg}: ${lowest_m - (tip_m + bucket_m - wanted_m)}`);
  }
});

test('a rocker has the train’s ratio and its cam under the pad', () => {
  const rocked = facts();
  rocked.trains[0].profile_m = rocked.trains[0].profile_m.map((r) => 0.018 + (r - 0.018) / 1.5);
  assert.ok(Math.abs(ratioOf(rocked.trains[0]) - 1.5) < 1e-9);
  const [part] = layoutOf(rocked).trains;
  assert.equal(part.kind, 'rocker');
  assert.ok(Math.abs(part.valveArm_m / part.camArm_m - 1.5) < 1e-9);
  assert.ok(Math.abs(part.cam.y_m + part.base_m - part.pad.y_m) < 1e-12);
  assert.ok(part.reach_m <= layoutOf(rocked).side_m);
});

test('an engine without valves has a picture too', () => {
  const bare = {...facts(), trains: []};
  const layout = layoutOf(bare);
  assert.equal(layout.trains.length, 0);
  assert.ok(layout.roof_m > layout.face_m && Number.isFinite(layout.side_m));
});

test('bars are where a state holds, split where the angle falls back', () => {
  const deg = [300, 400, 500, 600, 700, 50, 150, 250];
  const bars = (on) => barsOf(8, (i) => deg[i], (i) => on.includes(i));
  assert.deepEqual(bars([1, 2]), [[400, 600]]);
  assert.deepEqual(bars([4, 5]), [[700, 720], [0, 150]]);
  assert.deepEqual(bars([]), []);
  assert.deepEqual(bars([0, 1, 2, 3, 4, 5, 6, 7]), [[300, 720], [0, 250]]);
});

test('a wheel’s steps go over the whole cycle by the shown cylinder’s angle', () => {
  const edges = Float64Array.of(10, 0, 1, 100, 1, 0, 200, 0, 0);
  assert.deepEqual(stepsOf(edges, 0, 0), [[0, 0], [10, 1], [200, 0], [720, 0]]);
  assert.deepEqual(stepsOf(edges, 0, 50), [[0, 1], [150, 0], [680, 1], [720, 1]]);
  assert.deepEqual(stepsOf(edges, 2, 0), []);
});

test('rows by column name', () => {
  const rows = new Rows(['a', 'b'], Float64Array.of(1, 2, 3, 4));
  assert.equal(rows.count, 2);
  assert.equal(rows.get(1, 'b'), 4);
  assert.deepEqual([...rows.list('a')], [1, 3]);
  assert.equal(rows.has('c'), false);
});
