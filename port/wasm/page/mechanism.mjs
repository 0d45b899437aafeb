// The crank mechanism as a picture needs it, docs/model.md "Kinematics": lengths in metres, angles in radians; y points
// from the crank centre toward the head, x to the side to which the crank pin moves after top dead centre.

/// Where pin, piston pin and rod stand. mechanism: {crank_radius_m, rod_length_m, pin_offset_m}.
export function poseOf(mechanism, crank_rad) {
  const {crank_radius_m: r, rod_length_m: l, pin_offset_m: e} = mechanism;
  const pin = {x_m: r * Math.sin(crank_rad), y_m: r * Math.cos(crank_rad)};
  const aside_m = pin.x_m - e;
  const piston = {x_m: e, y_m: pin.y_m + Math.sqrt(l * l - aside_m * aside_m)};
  return {pin, piston, rod_rad: Math.asin(aside_m / l)};
}

/// Of the piston pin from the crank centre: highest and lowest place.
export function deadCentresOf({crank_radius_m: r, rod_length_m: l, pin_offset_m: e}) {
  return {top_m: Math.sqrt((l + r) ** 2 - e * e), bottom_m: Math.sqrt((l - r) ** 2 - e * e)};
}

/// Displacement from top dead centre, toward the crankshaft.
export function displacementOf(mechanism, crank_rad) {
  return deadCentresOf(mechanism).top_m - poseOf(mechanism, crank_rad).piston.y_m;
}

/// Volume above the piston; for p-V pictures. Needs bore_m and compression_ratio too.
export function volumeOf(mechanism, crank_rad) {
  const {top_m, bottom_m} = deadCentresOf(mechanism);
  const area_m2 = Math.PI / 4 * mechanism.bore_m ** 2;
  const clearance_m = (top_m - bottom_m) / (mechanism.compression_ratio - 1);
  return area_m2 * (clearance_m + displacementOf(mechanism, crank_rad));
}

/// Angle within 0 to below `period`; both of one unit.
export function wrapped(angle, period) {
  const rest = angle % period;
  return rest < 0 ? rest + period : rest;
}

/// From `a` to `b` the short way round, at `share` of it: for angles drawn between two ticks.
export function betweenAngles(a, b, share, period) {
  const step = wrapped(b - a + period / 2, period) - period / 2;
  return wrapped(a + share * step, period);
}

/// The stroke that a cylinder is in, by its own angle: firing top dead centre is 0.
export function strokeName(cylinder_deg) {
  return ['power', 'exhaust', 'intake', 'compression'][Math.floor(wrapped(cylinder_deg, 720) / 180)];
}
