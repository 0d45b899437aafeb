// How many ticks are due: model time follows the clock times a rate from 1/10 000 to 1, and never catches up more than
// a short stretch, so that a page that was hidden goes on where it was.

export const kSlowest = 1e-4;
const kLongestStretch_s = 0.1;  // of the clock

export class Pacing {
  constructor(tick_s, rate = 1) {
    this.tick_s = tick_s;
    this.rate = rate;
    this.owed = 0;  // ticks, with the fraction that has not run yet
    this.last_ms = null;
    this.dropped_ms = 0;  // of the clock, since the start: what was not caught up
  }

  setRate(rate) { this.rate = Math.min(1, Math.max(kSlowest, Number.isFinite(rate) ? rate : 1)); }

  setTick(tick_s) {
    this.owed = 0;
    this.tick_s = tick_s;
  }

  pause() { this.last_ms = null; }

  /// Whole ticks due at `now_ms`, at most `most`.
  due(now_ms, most = Infinity) {
    if (this.last_ms === null) {
      this.last_ms = now_ms;
      return 0;
    }
    const passed_ms = Math.max(0, now_ms - this.last_ms);
    const taken_ms = Math.min(passed_ms, 1000 * kLongestStretch_s);
    this.dropped_ms += passed_ms - taken_ms;
    this.last_ms = now_ms;
    this.owed += taken_ms * 1e-3 * this.rate / this.tick_s;
    const ticks = Math.min(Math.floor(this.owed + 1e-9), most);
    this.owed = Math.max(0, this.owed - ticks);
    return ticks;
  }

  /// What the machine could not do in time is given up, beyond one stretch: the model is slower than the clock then.
  giveUp() {
    const most = kLongestStretch_s * this.rate / this.tick_s;
    if (this.owed <= most) return 0;
    const lost = this.owed - most;
    this.owed = most;
    this.dropped_ms += lost * this.tick_s / this.rate * 1e3;
    return lost;
  }

  /// Share of the next tick that has passed, 0 to 1: pictures stand between two ticks.
  fraction(now_ms) {
    if (this.last_ms === null) return Math.min(1, this.owed);
    return Math.min(1, this.owed + Math.max(0, now_ms - this.last_ms) * 1e-3 * this.rate / this.tick_s);
  }
}

/// The slider of the rate: 0 to 100 is 1/10 000 to 1, by powers.
export function rateOfSlider(place) { return 10 ** (Math.min(100, Math.max(0, place)) / 25 - 4); }
export function sliderOfRate(rate) { return 25 * (Math.log10(rate) + 4); }

/// "real time", "1/10", "1/2500".
export function rateName(rate) {
  if (rate > 0.995) return 'real time';
  const part = 1 / rate;
  return '1/' + (part < 10 ? Number(part.toPrecision(2)) : Math.round(Number(part.toPrecision(2))));
}
