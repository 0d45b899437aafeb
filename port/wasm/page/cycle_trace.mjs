// One cycle of samples by crank angle, of fixed size: rows gather while the crank turns forward from one firing dead
// centre of cylinder 1 to the next; then they are the last whole cycle.

export const kMostRows = 2048;

export class CycleTrace {
  /// whole: whether the crank stands at the dead centre where a cycle begins.
  constructor(columns, whole = false) {
    this.columns = columns;
    this.rows = new Float64Array(columns * kMostRows);
    this.count = 0;
    this.whole = whole;  // whether row 0 is the first after a dead centre
    this.last_deg = NaN;
    this.reported = 0;   // rows of this cycle that takeNew() has given out
    this.restarted = true;
  }

  /// Takes samples; column `angle` is the crank angle in 0 to below 720. Calls ended(rows) at each whole cycle's end,
  /// rows being a view that holds until it returns.
  push(samples, angle, ended) {
    const n = this.columns;
    for (let i = 0; i + n <= samples.length; i += n) {
      const deg = samples[i + angle];
      const turned = deg - this.last_deg;
      if (turned < -360) this.#nextCycle(ended);
      else if (turned > 360 || this.count === kMostRows) this.#begin(false);  // backwards over it, or it stands still
      this.rows.set(samples.subarray(i, i + n), this.count * n);
      ++this.count;
      this.last_deg = deg;
    }
  }

  #nextCycle(ended) {
    if (this.whole) ended(this.rows.subarray(0, this.count * this.columns));
    this.#begin(true);
  }

  #begin(whole) {
    this.count = 0;
    this.reported = 0;
    this.restarted = true;
    this.whole = whole;
  }

  /// Copies of the rows of the current cycle since the last call, and whether they begin it anew.
  takeNew() {
    const rows = this.rows.slice(this.reported * this.columns, this.count * this.columns);
    const {restarted} = this;
    this.reported = this.count;
    this.restarted = false;
    return {rows, restarted};
  }
}

/// Every how many ticks a sample is taken, so that a cycle has at most three quarters of the rows that there are.
export function samplingOf(speed_rad_s, tick_s) {
  const least_rad_s = 3;  // below it a cycle is not shown whole
  const ticks = 4 * Math.PI / (Math.max(Math.abs(speed_rad_s), least_rad_s) * tick_s);
  return Math.max(1, Math.ceil(ticks / (0.75 * kMostRows)));
}

/// Crank angle at a time, from samples around it; rows are in the order of time_s (column 0), crank_deg is column 1.
export function angleAt(samples, columns, time_s) {
  const n = samples.length / columns;
  if (n === 0) return NaN;
  let low = 0;
  let high = n - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (samples[middle * columns] < time_s) low = middle + 1;
    else high = middle;
  }
  const after = Math.max(1, low);
  if (n < 2) return samples[1];
  const t0 = samples[(after - 1) * columns];
  const a0 = samples[(after - 1) * columns + 1];
  const turned = ((samples[after * columns + 1] - a0 + 1080) % 720) - 360;
  const deg = a0 + turned * (time_s - t0) / (samples[after * columns] - t0);
  return ((deg % 720) + 720) % 720;
}
