// Where the parts of one cylinder's picture stand, in metres from the crank centre, y toward the head: pure geometry.
// From the engine file: crank, rod, stroke, bore, clearance, heads, lifts, cams' base circles. Heights of piston, head
// and stems and the arms of rockers are of usual proportions to the bore, as the file does not have them.

import {camOutline, polarOutline, valveRow} from './cam_shape.mjs';
import {deadCentresOf} from './mechanism.mjs';

/// facts: page_facts() of module.h. trains: one picture of a valve for each train.
export function layoutOf(facts) {
  const {crank} = facts;
  const bore_m = crank.bore_m;
  const crown_m = 0.5 * bore_m;  // of the piston above its pin
  const {top_m, bottom_m} = deadCentresOf(crank);
  const clearance_m = (top_m - bottom_m) / (crank.compression_ratio - 1);
  const face_m = top_m + crown_m + clearance_m;
  const heads = facts.trains.map((train) => train.seat_m || 0.42 * bore_m);
  const row = valveRow(heads, bore_m);
  const trains = facts.trains.map((train, i) => trainOf(train, row[i], i, facts.trains.length, face_m, bore_m));
  const side_m = Math.max(0.62 * bore_m, crank.crank_radius_m + 0.2 * bore_m, ...trains.map((t) => t.reach_m));
  return {
    crank, bore_m, crown_m, face_m, trains, side_m, skirt_m: 0.3 * bore_m, wall_m: 0.07 * bore_m,
    liner_m: bottom_m - 0.2 * bore_m, floor_m: -(crank.crank_radius_m + 0.24 * bore_m),
    deck_m: face_m + 0.5 * bore_m, roof_m: Math.max(face_m + 0.6 * bore_m, ...trains.map((t) => t.roof_m)),
  };
}

function trainOf(train, place, index, count, face_m, bore_m) {
  const tip_m = face_m + 0.98 * bore_m;
  const outward = place.centre_m < 0 || (count === 1 && index === 0) ? -1 : 1;
  const base_m = train.base_circle_m;
  const common = {x_m: place.centre_m, head_m: place.diameter_m, tip_m, outward, base_m, train};
  return isDirect(train) ? directTrain(common, bore_m) : rockedTrain(common, bore_m);
}

/// Of valve lift to cam lift, at full lift.
export function ratioOf(train) {
  const cam_m = Math.max(...train.profile_m) - train.base_circle_m;
  return cam_m > 0 ? (train.max_lift_m + train.clearance_m) / cam_m : 1;
}

function isDirect(train) { return train.rocker === 'ratio' && Math.abs(ratioOf(train) - 1) < 0.02; }

/// The cam stands over a bucket on the stem.
function directTrain(common, bore_m) {
  const {x_m, tip_m, base_m, train} = common;
  const bucket_m = 0.1 * bore_m;
  const cam = {x_m, y_m: tip_m + bucket_m + base_m, contact_rad: -Math.PI / 2};
  return {...common, kind: 'direct', cam, bucket_m, cam_per_valve: 1, outline: outlineOf(train, 1),
          reach_m: Math.abs(x_m) + base_m + train.max_lift_m, roof_m: cam.y_m + base_m + train.max_lift_m};
}

/// A rocker turns over its pivot, outside the valve; its cam is under the other end.
function rockedTrain(common, bore_m) {
  const {x_m, tip_m, base_m, train, outward} = common;
  const ratio = ratioOf(train);
  const camArm_m = 0.5 * bore_m / (1 + ratio);
  const valveArm_m = ratio * camArm_m;
  const pivot = {x_m: x_m + outward * valveArm_m, y_m: tip_m + 0.12 * bore_m};
  const pad = {x_m: pivot.x_m + outward * camArm_m, y_m: tip_m + 0.02 * bore_m};
  const cam = {x_m: pad.x_m, y_m: pad.y_m - base_m, contact_rad: Math.PI / 2};
  return {...common, kind: 'rocker', cam, pivot, pad, camArm_m, valveArm_m, cam_per_valve: 1 / ratio,
          outline: outlineOf(train, 1 / ratio), reach_m: Math.abs(cam.x_m) + base_m + train.max_lift_m / ratio,
          roof_m: pivot.y_m + 0.12 * bore_m};
}

/// outline(enlarged): points of the cam about its centre, the lobe toward +x; made once for each enlargement.
function outlineOf(train, cam_per_valve) {
  const made = new Map();
  return (enlarged) => {
    if (!made.has(enlarged)) {
      const lift_m = liftFromLobe(train).map((lift) => enlarged * cam_per_valve * lift);
      made.set(enlarged, (enlarged === 1 ? camOutline : polarOutline)(lift_m, train.base_circle_m));
    }
    return made.get(enlarged);
  };
}

/// 360 lifts from full lift on; the table goes from -180 to 180 deg of the cam.
export function liftFromLobe({cam_deg, cam_lift_m}) {
  const n = cam_deg.length - 1;
  return Float64Array.from({length: n}, (_, i) => Math.max(0, cam_lift_m[(i + n / 2) % n]));
}

/// The cam's turn at which its table is read, 0 at full lift, in the cylinder's own crank angle.
export function camTurn_rad(train, cylinder_deg) { return (cylinder_deg - train.full_lift_deg) / 2 * Math.PI / 180; }
