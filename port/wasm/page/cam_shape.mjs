// A cam's outline from the lift of a flat follower: the curve whose support function is base circle and lift.

/// Outline as [x, y, x, y, ...] in metres, one point for each lift; lift_m is evenly spaced over a turn of the cam.
/// With h = base + lift over the cam angle t, its point is h (cos t, sin t) + dh/dt (-sin t, cos t).
export function camOutline(lift_m, base_circle_m) {
  const n = lift_m.length;
  const outline = new Float64Array(2 * n);
  const step_rad = 2 * Math.PI / n;
  for (let i = 0; i < n; ++i) {
    const h = base_circle_m + lift_m[i];
    const slope = (lift_m[(i + 1) % n] - lift_m[(i + n - 1) % n]) / (2 * step_rad);
    const c = Math.cos(i * step_rad);
    const s = Math.sin(i * step_rad);
    outline[2 * i] = h * c - slope * s;
    outline[2 * i + 1] = h * s + slope * c;
  }
  return outline;
}

/// The same points by base circle and lift along the radius: for lifts that no flat follower could follow.
export function polarOutline(lift_m, base_circle_m) {
  const outline = new Float64Array(2 * lift_m.length);
  lift_m.forEach((lift, i) => {
    outline[2 * i] = (base_circle_m + lift) * Math.cos(2 * Math.PI * i / lift_m.length);
    outline[2 * i + 1] = (base_circle_m + lift) * Math.sin(2 * Math.PI * i / lift_m.length);
  });
  return outline;
}

/// Where a valve's picture has its seat: poppets in one row over the bore, in metres from the cylinder's axis.
/// heads: diameters in metres, in the order in which they stand. They are drawn narrower where they would overlap.
export function valveRow(heads, bore_m) {
  const sum_m = heads.reduce((a, b) => a + b, 0);
  const room_m = 0.94 * bore_m;
  const gaps = heads.length + 1;
  const shrink = Math.min(1, (room_m - 0.02 * bore_m * gaps) / Math.max(sum_m, 1e-9));
  const gap_m = (room_m - shrink * sum_m) / gaps;
  let left_m = -room_m / 2;
  return heads.map((head_m) => {
    const place = {centre_m: left_m + gap_m + shrink * head_m / 2, diameter_m: shrink * head_m};
    left_m += gap_m + shrink * head_m;
    return place;
  });
}
