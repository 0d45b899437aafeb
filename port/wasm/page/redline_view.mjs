// The redline, found while one waits: separation and bounce over the speed, each train in turn, the run before in grey.

import {element, setText} from './dom.mjs';
import {readable} from './numbers.mjs';
import {Plot} from './plot.mjs';

const kWait_ms = 400;  // a text must rest so long before its search begins

export class RedlineView {
  /// worker: a second one, booted; parts: {gap, bounce (canvases), text (element), train (select)}.
  constructor(worker, parts) {
    Object.assign(this, {worker, parts, id: 0, timer: 0, source: null, train: null, speeds: [], before: null});
    this.onsets = new Map();        // of the engine as it is: train -> onsets
    this.onsetsBefore = new Map();  // of the engine before
    this.gap = new Plot(parts.gap);
    this.bounce = new Plot(parts.bounce);
    this.stale = true;
    parts.train.addEventListener('change', () => this.#search(parts.train.value));
  }

  get surfaces() { return [this.gap.surface, this.bounce.surface]; }

  /// A new engine: what was found of the one before stays in grey.
  setEngine(path, text, facts) {
    if (this.source?.text === text) return;
    const names = facts.trains.filter((train) => train.can_redline !== false).map((train) => train.name);
    if (this.onsets.size > 0) [this.onsetsBefore, this.before] = [this.onsets, this.speeds];
    this.onsets = new Map();
    this.source = {path, text};
    this.worker.postMessage({kind: 'stop'});
    clearTimeout(this.timer);
    this.#setNames(names);
    if (names.length === 0) setText(this.parts.text, 'This engine has no valve train whose redline can be searched.');
    else this.timer = setTimeout(() => this.#search(this.parts.train.value), kWait_ms);
  }

  #setNames(names) {
    const {train} = this.parts;
    const chosen = train.value;
    train.replaceChildren(...names.map((name) => element('option', {value: name}, name)));
    if (names.includes(chosen)) train.value = chosen;
    train.closest('section').hidden = names.length === 0;
  }

  #search(train) {
    if (this.train !== train) this.before = null;
    this.train = train;
    this.speeds = [];
    this.stale = true;
    setText(this.parts.text, `Searching the redline of ${train} …`);
    this.worker.postMessage({kind: 'redline', id: ++this.id, train, ...this.source});
  }

  /// A report of the second worker.
  take(message) {
    if (message.id !== this.id) return;
    if (message.kind === 'redline_begun') this.range = message.search;
    if (message.kind === 'refused') setText(this.parts.text, message.errors.map(({text}) => text).join(' '));
    if (message.kind === 'redline_speed') this.#takeSpeed(message.step);
    if (message.kind === 'redline_ended') this.#takeOnsets(message.onsets);
  }

  #takeSpeed({speed_rpm, results, part, done, of}) {
    const at = this.speeds.findIndex((speed) => speed.speed_rpm >= speed_rpm);
    this.speeds.splice(at < 0 ? this.speeds.length : at, 0, {speed_rpm, ...results});
    setText(this.parts.text, `Searching the redline of ${this.train}: ${part}, ${done} of ${of} speeds.`);
    this.stale = true;
  }

  #takeOnsets(onsets) {
    this.onsets.set(this.train, onsets);
    const was = this.onsetsBefore.get(this.train);
    const words = [['floats', 'separation_rpm'], ['bounces', 'bounce_rpm'], ['seats too fast', 'seating_rpm']]
      .map(([what, key]) => onsetWords(what, onsets, key, was));
    setText(this.parts.text, `Train ${this.train}: ${words.join('; ')}.`);
    this.parts.text.dataset.onsets = JSON.stringify({train: this.train, ...onsets});
    this.stale = true;
  }

  draw(palette, speed_rpm) {
    this.stale = false;
    const from = {low: this.range?.from_rpm ?? 500, high: this.#to_rpm()};
    this.#drawOne(palette, this.gap, from, speed_rpm, 'separation_gap_m', 'separation_rpm', 0);
    this.#drawOne(palette, this.bounce, from, speed_rpm, 'bounce_m', 'bounce_rpm', 1);
  }

  /// Shortly above the onset of separation, as `redline` draws it: beyond, the motion is chance.
  #to_rpm() {
    const onset = this.onsets.get(this.train)?.separation_rpm;
    return onset ? Math.min(this.range.to_rpm, 1.15 * onset) : this.range?.to_rpm ?? 15000;
  }

  #drawOne(palette, plot, x, speed_rpm, name, onset, number) {
    const curve = (speeds, style) => {
      const rows = Float64Array.from(speeds.flatMap((speed) => [speed.speed_rpm, 1e6 * (speed[name] ?? NaN)]));
      return {rows, n: 2, x: (list, at) => list[at], y: (list, at) => Math.min(list[at + 1], 1e6), ...style};
    };
    const inside = (speeds) => speeds.filter((speed) => speed.speed_rpm <= x.high && speed.is_possible !== false);
    const curves = [curve(inside(this.speeds), {colour: palette.series(number)})];
    if (this.before !== null) curves.unshift(curve(inside(this.before), {colour: palette.before, width: 1.5}));
    const limit_rpm = this.onsets.get(this.train)?.[onset];
    const bands = limit_rpm ? [{from: Math.min(limit_rpm, x.high), to: x.high, name: `from ${readable(limit_rpm)} rpm`}]
                            : [];
    const cursor = speed_rpm >= x.low && speed_rpm <= x.high ? speed_rpm : null;
    plot.draw(palette, {curves, x, bands, cursor, least_span: 100});
  }
}

function onsetWords(what, onsets, key, was) {
  const now = onsets[key];
  const text = now === null || now === undefined ? `${what} nowhere in the range` : `${what} from ${readable(now)} rpm`;
  const old = was?.[key];
  if (!now || !old || Math.round(now) === Math.round(old)) return text;
  const moved = now - old;
  return `${text} (${moved > 0 ? '+' : '−'}${readable(Math.abs(moved))})`;
}
