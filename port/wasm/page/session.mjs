// What the page knows of the engine that runs: the worker's reports, the text, the settings, the run before. All else
// on the page asks here and is told of changes.

import {kMostRows} from './cycle_trace.mjs';
import {numberOf} from './engine_text.mjs';
import {checked, kReports} from './protocol.mjs';
import {Rows} from './rows.mjs';

const kPause_ms = 1500;  // a change after so long a rest begins a new comparison

export class Session {
  /// worker: takes postMessage(), gives onmessage; source: {path, text, files}.
  constructor(worker, source) {
    this.worker = worker;
    this.path = source.path;
    this.text = source.text;     // what stands in the editor
    this.loaded = null;          // the text that runs
    this.settings = {tick_us: 50, in_double: false, free: false, crank_deg: 0,
                     speed_rpm: numberOf(source.text, 'engine', 'rated_rpm') ?? 2000};
    this.engine = null;          // the report 'engine'
    this.frame = null;
    this.cycle = null;           // {rows: Rows, edges, results, engine} of the last whole cycle
    this.current = null;         // Rows of the cycle that goes on
    this.kept = null;            // the cycle of the run before
    this.cylinder = 1;
    this.paused = false;
    this.rate = 1;
    this.asked = 0;
    this.busy = false;           // a load is under way
    this.waiting = false;        // another text came meanwhile
    this.changed_ms = -Infinity;
    this.listeners = new Map();
    this.answers = new Map();
    worker.onmessage = ({data}) => this.#take(checked(data, kReports));
  }

  on(kind, call) {
    if (!this.listeners.has(kind)) this.listeners.set(kind, []);
    this.listeners.get(kind).push(call);
  }

  tell(kind, ...about) { for (const call of this.listeners.get(kind) ?? []) call(...about); }

  order(message, moved = []) { this.worker.postMessage(message, moved); }

  /// A new text; the newest counts where they come faster than they are read.
  setText(text) {
    this.text = text;
    this.tell('text', text);
    this.#keepBefore();
    this.#load();
  }

  #load() {
    if (this.busy) {
      this.waiting = true;
      return;
    }
    this.busy = true;
    this.waiting = false;
    this.sent = this.text;
    this.order({kind: 'load', id: ++this.asked, path: this.path, text: this.text,
                settings: {...this.settings, crank_deg: this.engine === null ? 0 : null}});
  }

  /// Starts the engine anew with other settings, at the angle where it stands unless crank_deg is given.
  setSettings(change) {
    this.settings = {...this.settings, crank_deg: null, ...change};
    this.order({kind: 'settings', id: ++this.asked, settings: this.settings});
  }

  setInput(base, value) { this.order({kind: 'input', base, value}); }

  setCylinder(cylinder) {
    const count = this.engine?.facts.cylinders.length ?? 1;
    this.cylinder = Math.min(Math.max(1, cylinder), count);
    this.cycle = this.kept = null;
    this.order({kind: 'cylinder', cylinder: this.cylinder});
    this.tell('cylinder', this.cylinder);
  }

  setPaused(paused) {
    this.paused = paused;
    this.order({kind: 'pause', paused});
    this.tell('paused', paused);
  }

  setRate(rate) {
    this.rate = rate;
    this.order({kind: 'rate', rate});
    this.tell('rate', rate);
  }

  step(ticks, cycle = false) {
    if (!this.paused) this.setPaused(true);
    this.order({kind: 'step', ticks, cycle});
  }

  keep() {
    this.kept = this.cycle;
    this.tell('kept', this.kept);
  }

  forget() {
    this.kept = null;
    this.tell('kept', null);
  }

  /// The run before a row of changes is what they are compared with.
  #keepBefore() {
    const now_ms = performance.now();
    if (now_ms - this.changed_ms > kPause_ms && this.cycle !== null) this.keep();
    this.changed_ms = now_ms;
  }

  /// An answer to one question: order with an id of its own.
  ask(message) {
    const id = ++this.asked;
    this.order({...message, id});
    return new Promise((resolve) => this.answers.set(id, resolve));
  }

  #take(message) {
    const take = {engine: () => this.#takeEngine(message), refused: () => this.#takeRefused(message),
                  frame: () => this.#takeFrame(message)}[message.kind];
    if (take) take();
    this.answers.get(message.id)?.(message);
    this.answers.delete(message.id);
    this.tell(message.kind, message);
  }

  #takeEngine(message) {
    this.#loadEnded();
    this.loaded = this.sent;
    this.engine = message;
    this.settings = {...message.settings, speed_rpm: this.settings.speed_rpm};  // a hand may have moved it meanwhile
    this.cylinder = Math.min(this.cylinder, message.facts.cylinders.length);
    this.current = null;
    if (this.kept !== null && this.kept.rows.columns.join() !== message.columns.join()) this.forget();
  }

  #takeRefused() { this.#loadEnded(); }

  #loadEnded() {
    this.busy = false;
    if (this.waiting) this.#load();
  }

  #takeFrame(frame) {
    this.frame = {...frame, now: new Rows(frame.columns, frame.now), before: new Rows(frame.columns, frame.before)};
    this.#gather(frame);
    if (frame.cycle === null) return;
    const {rows, edges, results} = frame.cycle;
    this.cycle = {rows: new Rows(frame.columns, rows), edges, results, engine: this.engine};
    this.tell('cycle', this.cycle);
  }

  /// Rows of the cycle that goes on, in room that is made once for as many columns.
  #gather({columns, partial, restarted}) {
    const most = kMostRows * columns.length;
    if (this.room?.length !== most) this.room = new Float64Array(most);
    const have = this.current === null || restarted || this.current.n !== columns.length ? 0 : this.current.data.length;
    const size = Math.min(partial.length, most - have);
    this.room.set(partial.subarray(0, size), have);
    this.current = new Rows(columns, this.room.subarray(0, have + size));
  }
}

