// Scales of a scope: which range it shows, where its ticks are, and how they read.

/// The steps that people read: 1, 2, 2.5, 5 times a power of ten; crank angles have their own.
const kSteps = [1, 2, 2.5, 5, 10];

export function niceStep(span, most_ticks) {
  const least = span / Math.max(1, most_ticks);
  const power = 10 ** Math.floor(Math.log10(least));
  for (const step of kSteps) {
    if (step * power >= least * (1 - 1e-12)) return step * power;
  }
  return 10 * power;
}

/// Ticks from low to high, both within; none where the range is empty or not finite.
export function ticksOf(low, high, most_ticks) {
  if (!(high > low) || !Number.isFinite(high - low)) return [];
  const step = niceStep(high - low, most_ticks);
  const ticks = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; ++n) ticks.push(tidy(n * step, step));
  return ticks;
}

function tidy(value, step) {
  const digits = Math.max(0, 2 - Math.floor(Math.log10(step)));
  return Number(value.toFixed(Math.min(digits, 20))) + 0;  // no -0
}

/// Crank angle: a quarter, half or whole stroke between ticks.
export function angleTicks(low_deg, high_deg, most_ticks) {
  const step = [15, 30, 45, 90, 180, 360].find((s) => (high_deg - low_deg) / s <= most_ticks) ?? 720;
  const ticks = [];
  for (let a = Math.ceil(low_deg / step) * step; a <= high_deg + 1e-9; a += step) ticks.push(a);
  return ticks;
}

/// Extent of finite values of some curves (plot.mjs) along an axis, 'x' or 'y'; {low: 0, high: 0} of none.
export function extentOf(curves, axis) {
  let low = Infinity;
  let high = -Infinity;
  for (const curve of curves) {
    for (let at = 0; at < curve.rows.length; at += curve.n) {
      const v = curve[axis](curve.rows, at);
      if (v < low && v > -Infinity) low = v;
      if (v > high && v < Infinity) high = v;
    }
  }
  return low <= high ? {low, high} : {low: 0, high: 0};
}

/// The range of a scope: round, holds the extent, and keeps the old range while the extent fits in and fills a third of
/// it, so that a scope does not breathe from cycle to cycle. old: null or a range from here. below: share of the extent
/// that may stand below zero without a range of its own.
export function steadyRange(extent, old, {zero = true, least_span = 1e-12, below = 0} = {}) {
  let {low, high} = extent;
  if (zero) {
    low = -low <= below * (high - low) ? 0 : Math.min(low, 0);
    high = Math.max(high, 0);
  }
  if (old !== null && low >= old.low && high <= old.high && high - low >= (old.high - old.low) / 3) return old;
  if (!(high - low >= least_span)) {
    const middle = (low + high) / 2;
    low = zero && low >= 0 ? 0 : middle - least_span / 2;
    high = low + least_span;
  }
  const step = niceStep(high - low, 5);
  return {low: Math.floor(low / step + 1e-9) * step, high: Math.ceil(high / step - 1e-9) * step};
}

/// From a range onto pixels: from.low at to.low.
export function mapping(from, to) {
  const slope = (to.high - to.low) / (from.high - from.low);
  const map = (value) => to.low + (value - from.low) * slope;
  map.back = (pixel) => from.low + (pixel - to.low) / slope;
  return map;
}
