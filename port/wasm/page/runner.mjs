// The engine as the worker runs it: loads and starts it, steps what the pacing says is due, gathers cycles and edges.
// Everything in it is of fixed size. It knows no messages' transport: worker.mjs does.

import {angleAt, CycleTrace, samplingOf} from './cycle_trace.mjs';
import {Pacing} from './pacing.mjs';
import {Ring} from './ring.mjs';
import {watchedOf} from './watched.mjs';

const kSlice = 256;           // ticks between two looks at the clock
const kBudget_ms = 12;        // of computing for one frame
const kCycleEvery_ms = 60;    // whole cycles go out at most so often
const kEdges = 16384;

export class Runner {
  constructor(module, clock) {
    this.module = module;
    this.clock = clock;  // in ms
    this.pacing = null;
    this.paused = false;
    this.rate = 1;
    this.cylinder = 1;
    this.edges = new Ring(4, kEdges);  // time_s, wheel, level, crank_deg
    this.chosen = new Map();           // inputs that the page has set, by base name
    this.load = 0;
    this.faults = 0;
  }

  get running() { return this.pacing !== null; }

  /// Reads a text and starts it; errors change nothing.
  open(path, text, settings) {
    const began_ms = this.clock();
    const read = this.module.load(path, text);
    if (read.errors.length > 0) return {errors: read.errors};
    return this.start(settings, read.warnings, began_ms);
  }

  /// Starts the loaded engine anew. crank_deg null: where the crank stands.
  start(settings, warnings = [], began_ms = this.clock()) {
    const request = this.#goingOn(settings);
    const started = this.module.start(request);
    if (started.errors.length > 0) return {errors: started.errors};
    this.settings = {...request, crank_deg: null};
    this.faults = 0;
    this.facts = this.module.facts();
    this.cylinder = Math.min(this.cylinder, this.facts.cylinders.length);
    this.inputs = this.module.inputs().map((input) => ({...input, base: input.name.replace(/\[.*/, '')}));
    this.results = this.module.results();
    for (const [base, value] of this.chosen)
      if (base !== 'speed_rad_s') this.#put(base, value);
    this.pacing = new Pacing(settings.tick_us * 1e-6, this.rate);
    this.watch(this.cylinder, request.crank_deg === 0);
    this.edges.clear();
    return {
      errors: [], facts: this.facts, inputs: this.inputs,
      values: this.module.inputValues(this.inputs.length).slice(), columns: this.columns, results: this.results,
      warnings: [...warnings, ...started.warnings], settings: this.settings, took_ms: this.clock() - began_ms,
      settling_cycles: started.settling_cycles ?? 0,
    };
  }

  /// crank_deg null: the angle where the crank stands, and of a free crank its speed.
  #goingOn(settings) {
    if (settings.crank_deg !== null || !this.running) return {...settings, crank_deg: settings.crank_deg ?? 0};
    const isFree = settings.free && this.settings.free;
    const speed_rpm = isFree ? this.#speed_rad_s() * 30 / Math.PI : settings.speed_rpm;
    return {...settings, speed_rpm, crank_deg: this.now[1]};
  }

  /// whole: whether a cycle begins here.
  watch(cylinder, whole = false) {
    this.cylinder = Math.min(Math.max(1, cylinder), this.facts.cylinders.length);
    const names = this.module.channels().map((channel) => channel.name);
    this.module.watch(watchedOf(names, this.cylinder));
    this.columns = this.module.columns();
    this.speedColumn = this.columns.indexOf('speed_rad_s');
    this.faultColumn = this.columns.indexOf('faults');
    this.trace = new CycleTrace(this.columns.length, whole);
    this.cycle = null;
    this.now = this.module.now(this.columns.length).slice();
    this.before = this.now.slice();
    this.cycleSent_ms = -Infinity;
  }

  setInput(base, value) {
    this.chosen.set(base, value);
    this.#put(base, value);
  }

  #put(base, value) {
    const values = this.module.inputValues(this.inputs.length);
    this.inputs.forEach((input, i) => {
      if (input.base === base) values[i] = value;
    });
  }

  setRate(rate) {
    this.rate = rate;
    this.pacing?.setRate(rate);
  }

  setPaused(paused) {
    this.paused = paused;
    if (paused) this.pacing?.pause();
  }

  /// Ticks one by one: pictures stand at a tick then, not between two.
  stepTicks(ticks) {
    this.#step(ticks);
    this.before.set(this.now);
  }

  /// To the first tick of the next cycle: what ended is whole then, if it began so.
  stepCycle() {
    const ticks = Math.ceil(4 * Math.PI / (Math.max(3, Math.abs(this.#speed_rad_s())) * this.settings.tick_us * 1e-6));
    for (let i = 0; i < 2 * ticks; ++i) {
      const [, deg] = this.now;
      this.#step(1);
      if (this.now[1] < deg - 360) break;
    }
    this.before.set(this.now);
    this.cycleSent_ms = -Infinity;
  }

  /// What is due now, as the report of a frame.
  frame() {
    const began_ms = this.clock();
    if (!this.paused) this.#stepDue(began_ms);
    const {rows, restarted} = this.trace.takeNew();
    return {
      now: this.now.slice(), before: this.before.slice(),
      share: this.paused ? 1 : this.pacing.fraction(this.clock()), partial: rows, restarted,
      cycle: this.#takeCycle(began_ms), cycles: this.module.cycles(), load: this.load,
      faults: this.faults, columns: this.columns,
    };
  }

  #stepDue(began_ms) {
    const due = this.pacing.due(began_ms);
    let left = due;
    while (left > 0 && this.clock() - began_ms < kBudget_ms) {
      const ticks = Math.min(left, kSlice);
      this.#step(ticks);
      left -= ticks;
    }
    this.pacing.owed += left;
    this.pacing.giveUp();
    if (due > left) this.#weigh(this.clock() - began_ms, due - left);
  }

  /// Share of the clock that the model takes at real time; smoothed.
  #weigh(took_ms, ticks) {
    const load = took_ms / (ticks * this.settings.tick_us * 1e-3);
    this.load += 0.05 * (load - this.load);
  }

  #speed_rad_s() { return this.speedColumn >= 0 ? this.now[this.speedColumn] : this.settings.speed_rpm * Math.PI / 30; }

  #step(ticks) {
    const n = this.columns.length;
    const every = samplingOf(this.#speed_rad_s(), this.settings.tick_us * 1e-6);
    if (ticks > 1) {
      this.module.step(ticks - 1, every);
      this.#gather(n);
    }
    this.before.set(this.module.now(n));
    this.module.step(1, every);
    this.#gather(n);
    this.now.set(this.module.now(n));
  }

  #gather(n) {
    const samples = this.module.samples(n);
    const edges = this.module.edges();
    this.#placeEdges(edges, samples, n);
    this.#noteFaults(samples, n);
    this.trace.push(samples, 1, (rows) => this.#endCycle(rows));
  }

  /// All that samples have shown since the start.
  #noteFaults(samples, n) {
    if (this.faultColumn < 0) return;
    for (let at = this.faultColumn; at < samples.length; at += n) this.faults |= samples[at];
  }

  #placeEdges(edges, samples, n) {
    const placed = samples.length >= 2 * n;
    for (let i = 0; i < edges.length; i += 3) {
      const deg = placed ? angleAt(samples, n, edges[i]) : this.#angleInTick(edges[i]);
      this.edges.push([edges[i], edges[i + 1], edges[i + 2], deg]);
    }
  }

  /// Of an edge in the last few ticks, by the speed.
  #angleInTick(time_s) {
    const now = this.module.now(this.columns.length);
    const deg = now[1] - (now[0] - time_s) * this.#speed_rad_s() * 180 / Math.PI;
    return ((deg % 720) + 720) % 720;
  }

  #endCycle(rows) {
    if (this.clock() - this.cycleSent_ms < kCycleEvery_ms) return;
    this.cycle = {rows: rows.slice(), edges: this.#edgesSince(rows[0], rows[rows.length - this.columns.length])};
  }

  /// Flat rows of angle, wheel, level.
  #edgesSince(from_s, to_s) {
    let first = this.edges.size;
    while (first > 0 && this.edges.get(first - 1, 0) >= from_s) --first;
    const rows = [];
    for (let i = first; i < this.edges.size && this.edges.get(i, 0) <= to_s; ++i)
      rows.push(this.edges.get(i, 3), this.edges.get(i, 1), this.edges.get(i, 2));
    return Float64Array.from(rows);
  }

  #takeCycle(now_ms) {
    if (this.cycle === null || now_ms - this.cycleSent_ms < kCycleEvery_ms) return null;
    const {rows, edges} = this.cycle;
    this.cycle = null;
    this.cycleSent_ms = now_ms;
    return {rows, edges, results: this.module.resultValues(this.results.length).slice()};
  }

  /// The newest edges of all wheels, for a value change dump: flat rows of time_s, wheel, level.
  allEdges() {
    const rows = new Float64Array(3 * this.edges.size);
    for (let i = 0; i < rows.length; ++i) rows[i] = this.edges.get(Math.floor(i / 3), i % 3);
    return {rows, end_s: this.now[0]};
  }
}
