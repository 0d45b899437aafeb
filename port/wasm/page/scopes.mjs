// The scopes over the shown cylinder's crank angle: what each draws, out of a cycle's rows. They redraw only when there
// is something new.

import {Plot, LanePlot} from './plot.mjs';
import {barsOf, stepsOf} from './lanes.mjs';
import {ReadOut} from './readout.mjs';
import {volumeOf, wrapped} from './mechanism.mjs';
import {pressureName} from './watched.mjs';

const kCycle = {low: 0, high: 720, angle: true};
const kStrokes = [['power', 'power', 0], ['exhaust', 'exh.', 180], ['intake', 'intake', 360],
                  ['compression', 'compr.', 540]].map(([name, short, from]) => ({name, short, from, to: from + 180}));

/// What a scope needs of a run: its rows, and the engine's facts of that run.
export class View {
  constructor({rows, engine}, cylinder) {
    this.rows = rows;
    this.facts = engine.facts;
    this.cylinder = cylinder;
    this.firing_deg = engine.facts.cylinders[cylinder - 1]?.firing_deg ?? 0;
    this.pressure = [true, false].map((gas) => pressureName(cylinder, gas)).find((name) => rows.has(name)) ?? null;
  }

  angle(row) { return wrapped(row - this.firing_deg, 720); }

  /// A curve of one column over the own angle.
  curve(name, factor, style) {
    if (name === null || !this.rows.has(name)) return [];
    const c = this.rows.at.get(name);
    return [{rows: this.rows.data, n: this.rows.n, x: (rows, at) => this.angle(rows[at + 1]),
             y: (rows, at) => factor * rows[at + c], wraps: true, ...style}];
  }

  difference(name, from, factor, style) {
    if (!this.rows.has(name) || !this.rows.has(from)) return [];
    const a = this.rows.at.get(name);
    const b = this.rows.at.get(from);
    return [{rows: this.rows.data, n: this.rows.n, x: (rows, at) => this.angle(rows[at + 1]),
             y: (rows, at) => factor * (rows[at + a] - rows[at + b]), wraps: true, ...style}];
  }

  overVolume(style) {
    if (this.pressure === null) return [];
    const c = this.rows.at.get(this.pressure);
    const {crank} = this.facts;
    const volume = (deg) => 1e6 * volumeOf(crank, (deg - this.firing_deg) * Math.PI / 180);
    return [{rows: this.rows.data, n: this.rows.n, x: (rows, at) => volume(rows[at + 1]),
             y: (rows, at) => 1e-3 * rows[at + c], closed: true, ...style}];
  }

  /// name(train number) of each train, with the train's colour.
  ofTrains(palette, before, of) {
    return this.facts.trains.flatMap((train, t) => of(t + 1, plain(palette, before, train.name, t)));
  }
}

function valve(what, t, cylinder) { return `valve[${t},${cylinder}].${what}`; }
function force(what, t, cylinder) { return `valve_forces[${t},${cylinder}].${what}`; }
/// The style of a curve with its name; that of the run before has none and is grey.
function plain(palette, before, name, number = 0) {
  return before ? {colour: palette.before, width: 1.5} : {colour: palette.series(number), width: 2, name};
}

/// Each with its id on the page and its curves of a run; `before` draws the grey one.
const kCurves = {
  pressure: {curves: (v, p, before) => v.curve(v.pressure, 1e-3, plain(p, before, 'kPa')), least_span: 1},
  volume: {curves: (v, p, before) => v.overVolume(plain(p, before, 'kPa')), x: null, least_span: 1},
  torque: {
    curves: (v, p, before) => [
      ...v.curve('torque_Nm', 1, plain(p, before, 'engine, Nm')),
      ...(before || v.facts.cylinders.length === 1 ? [] : v.curve(`cylinder[${v.cylinder}].torque_Nm`, 1,
                                {...plain(p, before, 'cylinder, Nm', 1), width: 1}))],
    least_span: 0.1,
  },
  lift: {
    curves: (v, p, before) => v.ofTrains(p, before, (t, style) => [
      ...(before ? [] : v.curve(valve('theoretical_lift_m', t, v.cylinder), 1e3,
                                {colour: p.muted, width: 1.5, dash: [4, 4]})),
      ...v.curve(valve('lift_m', t, v.cylinder), 1e3, style)]),
    least_span: 0.1, below: 0.03,  // a valve gives way by a tenth of a millimetre where its train presses
  },
  difference: {
    curves: (v, p, before) => v.ofTrains(p, before, (t, style) => v.difference(
      valve('lift_m', t, v.cylinder), valve('theoretical_lift_m', t, v.cylinder), 1e6, style)),
    least_span: 10,
  },
  force: {
    curves: (v, p, before) => v.ofTrains(p, before, (t, style) => v.curve(force('train_N', t, v.cylinder), 1, style)),
    least_span: 10,
  },
};

export class Scopes {
  /// canvasOf(id): the canvas of a scope; its figure is hidden while the engine has nothing for it.
  constructor(canvasOf) {
    this.plots = Object.entries(kCurves).map(([id, spec]) => ({id, spec, plot: new Plot(canvasOf(id))}));
    const readOut = new ReadOut();
    for (const {id, spec, plot} of this.plots) readOut.watch(canvasOf(id), plot, spec.x === null ? 'cm³' : 'deg');
    this.contacts = new LanePlot(canvasOf('contacts'));
    this.wheels = new LanePlot(canvasOf('wheels'));
    this.figures = new Map([...Object.keys(kCurves), 'contacts', 'wheels'].map((id) => [id, canvasOf(id)]));
  }

  get surfaces() { return [...this.plots.map(({plot}) => plot), this.contacts, this.wheels].map((p) => p.surface); }
  get stale() { return this.surfaces.some((surface) => surface.stale); }

  /// cycle, kept, current: of the session; cursor_deg: engine angle, or null.
  draw(palette, {cycle, kept, current, engine, cylinder, cursor_deg}) {
    const run = cycle ?? (current !== null && current.count > 1 ? {rows: current, edges: null, engine} : null);
    if (run === null) return;
    const views = {now: new View(run, cylinder), before: kept === null ? null : new View(kept, cylinder)};
    views.traced = cycle !== null && cursor_deg !== null && current !== null ? new View({rows: current, engine},
                                                                                        cylinder) : null;
    const cursor = cursor_deg === null ? null : views.now.angle(cursor_deg);
    for (const {id, spec, plot} of this.plots) this.#drawCurves(palette, id, spec, plot, views, cursor);
    this.#drawContacts(palette, views.now, cursor);
    this.#drawWheels(palette, run, views.now, cursor);
  }

  #show(id, is) { this.figures.get(id).closest('figure').hidden = !is; }

  #drawCurves(palette, id, spec, plot, {now, before, traced}, cursor) {
    const own = spec.curves(now, palette, false);
    this.#show(id, own.length > 0);
    if (own.length === 0) return;
    const grey = before === null ? [] : spec.curves(before, palette, true);
    const fresh = traced === null ? [] : spec.curves(traced, palette, false);
    const thin = (curve) => ({...curve, width: 0.75});  // the last cycle, while the next is being drawn over it
    const open = (curve) => ({...curve, closed: false});
    const curves = fresh.length === 0 ? [...grey, ...own] : [...grey, ...own.map(thin), ...fresh.map(open)];
    const overAngle = spec.x === undefined;
    plot.draw(palette, {curves, x: overAngle ? kCycle : null, bands: overAngle ? kStrokes : [],
                        cursor: overAngle ? cursor : null, least_span: spec.least_span, below: spec.below});
  }

  #drawContacts(palette, view, cursor) {
    const names = view.facts.trains.map((train, t) => force('regime', t + 1, view.cylinder));
    const has = names.length > 0 && names.every((name) => view.rows.has(name));
    this.#show('contacts', has);
    if (!has) return;
    const lanes = view.facts.trains.flatMap((train, t) => [['train', 1], ['seat', 2]].map(([part, bit]) => ({
      name: `${train.name} ${part}`, colour: palette.series(t),
      bars: barsOf(view.rows.count, (i) => view.angle(view.rows.get(i, 'crank_deg')),
                   (i) => (view.rows.get(i, names[t]) & bit) !== 0),
    })));
    this.contacts.draw(palette, {lanes, x: kCycle, bands: kStrokes, cursor});
  }

  #drawWheels(palette, run, view, cursor) {
    const wheels = view.facts.wheels ?? [];
    this.#show('wheels', wheels.length > 0);
    if (wheels.length === 0) return;
    const lanes = wheels.map((wheel, w) => ({
      name: wheel.name, colour: palette.series(w + 2), steps: stepsOf(run.edges ?? [], w, view.firing_deg)}));
    this.wheels.draw(palette, {lanes, x: kCycle, bands: kStrokes, cursor});
  }
}
