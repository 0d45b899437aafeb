// The controls of the running engine: crank held or free, load, fuel, tick; each does one order of the session.

import {check, choice, element, slider} from './dom.mjs';

/// Inputs that get a slider where the engine has them: base, label, unit, shown per unit, min, max, step.
const kInputs = [
  ['load_ratio', 'Load ratio', '', 1, 0, 2, 0.01],
  ['throttle_ratio', 'Throttle', '', 1, 0, 1, 0.005],
  ['external_torque_Nm', 'Load torque', 'Nm', 1, -200, 600, 1],
  ['excess_air_ratio', 'Lambda', '', 1, 0.6, 3, 0.01],
  ['fuel_kg', 'Fuel per cycle', 'mg', 1e6, 0, 120, 0.5],
  ['burn_start_deg', 'Burn start', 'deg', 1, -60, 30, 0.5],
];
const kTicks_us = [5, 10, 20, 50, 100, 200, 500, 1000];

export class Controls {
  constructor(root, session) {
    Object.assign(this, {root, session, inputs: new Map(), key: '', fuelBy: 'lambda'});
    this.speed = slider({label: 'Speed', unit: 'rpm', min: 50, max: 10000, step: 10, value: session.settings.speed_rpm,
                         key: '↑ ↓', change: (rpm) => this.#setSpeed(rpm)});
    this.crank = choice({legend: 'Crank', options: [['held', 'speed held'], ['free', 'free']], value: 'held',
                         change: (to) => this.#setFree(to === 'free')});
    this.starter = check({label: 'Starter (s)', change: (on) => session.setInput('starter', on ? 1 : 0)});
    this.real = choice({legend: 'Arithmetic', options: [['float', 'float'], ['double', 'double']], value: 'float',
                        change: (to) => session.setSettings({in_double: to === 'double'})});
    this.fuel = choice({legend: 'Fuel by', options: [['lambda', 'lambda'], ['mass', 'mass']], value: 'lambda',
                        change: (to) => this.#setFuelBy(to)});
    this.cut = new Set();
    this.tick = element('select', {id: 'tick-length', onchange: () => session.setSettings(
      {tick_us: Number(this.tick.value)})}, ...kTicks_us.map((us) => element('option', {value: us}, `${us} µs`)));
    session.on('engine', (engine) => this.#setEngine(engine));
  }

  #setSpeed(rpm) {
    this.session.settings.speed_rpm = rpm;
    if (!this.session.settings.free) this.session.setInput('speed_rad_s', rpm * Math.PI / 30);
  }

  /// The arrow keys.
  changeSpeed(factor) {
    const to = Math.min(Number(this.speed.range.max), Math.max(50, Math.round(this.speed.get() * factor / 10) * 10));
    this.speed.set(to);
    this.#setSpeed(to);
  }

  #setFree(free) {
    const now = this.session.frame?.now;
    const rpm = now?.has('speed_rad_s') ? now.get(0, 'speed_rad_s') * 30 / Math.PI : this.speed.get();
    this.session.setSettings({free, speed_rpm: free ? rpm : this.speed.get()});
  }

  toggleFree() { this.#setFree(!this.session.settings.free); }
  toggleStarter() { this.starter.input.click(); }
  toggleCut(cylinder) { this.cuts?.[cylinder - 1]?.input.click(); }

  #setFuelBy(to) {
    this.fuelBy = to;
    const lambda = this.inputs.get('excess_air_ratio');
    this.session.setInput('excess_air_ratio', to === 'lambda' ? lambda.get() : 0);
    if (to === 'mass') this.session.setInput('fuel_kg', this.inputs.get('fuel_kg').get() * 1e-6);
    this.#showFuel();
  }

  #showFuel() {
    const [lambda, fuel] = ['excess_air_ratio', 'fuel_kg'].map((base) => this.inputs.get(base));
    if (lambda) lambda.node.hidden = this.fuelBy !== 'lambda';
    if (fuel) fuel.node.hidden = this.fuelBy !== 'mass';
  }

  #setEngine({facts, inputs, values, settings}) {
    const key = JSON.stringify([facts.path, facts.cylinders.length, inputs.map(({base}) => base)]);
    if (key !== this.key) this.#make(facts, inputs, values);
    this.key = key;
    this.speed.range.max = String(facts.max_rpm ?? Math.ceil(1.5 * facts.rated_rpm / 100) * 100);
    this.speed.set(Math.round(this.session.settings.speed_rpm));
    this.speed.node.hidden = settings.free;
    this.crank.set(settings.free ? 'free' : 'held');
    this.tick.value = String(settings.tick_us);
    this.real.set(settings.in_double ? 'double' : 'float');
  }

  #make(facts, inputs, values) {
    const bases = inputs.map(({base}) => base);
    const valueOf = (base) => values[bases.indexOf(base)];
    this.inputs = new Map(kInputs.filter(([base]) => bases.includes(base)).map((one) => [one[0], this.#input(one,
                                                                                      valueOf(one[0]))]));
    if (bases.includes('excess_air_ratio')) this.fuelBy = valueOf('excess_air_ratio') > 0 ? 'lambda' : 'mass';
    this.fuel.set(this.fuelBy);
    const isGas = this.inputs.has('fuel_kg');
    this.root.replaceChildren(
      this.crank.node, this.speed.node, ...(bases.includes('starter') && facts.has_starter ? [this.starter.node] : []),
      ...this.#nodesOf(['external_torque_Nm', 'load_ratio', 'throttle_ratio']), ...(isGas ? [this.fuel.node] : []),
      ...this.#nodesOf(['excess_air_ratio', 'fuel_kg', 'burn_start_deg']),
      ...(bases.includes('cut_cylinders') ? [this.#cuts(facts)] : []),
      element('div', {class: 'pair'}, element('label', {for: 'tick-length'}, 'Tick'), this.tick), this.real.node);
    this.#showFuel();
  }

  #nodesOf(bases) { return bases.flatMap((base) => this.inputs.has(base) ? [this.inputs.get(base).node] : []); }

  #input([base, label, unit, per, min, max, step], value) {
    const shown = Number((value * per).toPrecision(6));
    const start = base === 'excess_air_ratio' && !(shown > 0) ? 1 : shown;
    return slider({label, unit, min: Math.min(min, start), max: Math.max(max, start), step, value: start,
                   change: (to) => this.session.setInput(base, to / per)});
  }

  #cuts({cylinders}) {
    this.cuts = cylinders.map((_, i) => check({label: String(i + 1), value: this.cut.has(i), change: (on) => {
      if (on) this.cut.add(i);
      else this.cut.delete(i);
      this.session.setInput('cut_cylinders', [...this.cut].reduce((bits, k) => bits + 2 ** k, 0));
    }}));
    return element('fieldset', {class: 'choice'}, element('legend', {}, 'Cut cylinders'),
                   ...this.cuts.map(({node}) => node));
  }
}
