// An engine's module for tests of what is around it: two cylinders, one train, one wheel, all by plain formulas of the
// crank angle and of two values in the engine file. It answers as module.h says. A text with the word "bad" is refused
// at its line, in words that are markup.

import {numberOf, valueOf} from '../../port/wasm/page/engine_text.mjs';

const kFiring_deg = [0, 360];
const kOfCylinder = [1, 2].flatMap((k) => [
  `cylinder[${k}].pressure_Pa`, `cylinder[${k}].torque_Nm`, `valve[1,${k}].theoretical_lift_m`, `valve[1,${k}].lift_m`,
  `valve_forces[1,${k}].regime`, `valve_forces[1,${k}].train_N`]);
const kChannels = ['speed_rad_s', 'torque_Nm', ...kOfCylinder];
const kInputs = ['speed_rad_s', 'throttle_ratio', 'fuel_kg[1]', 'fuel_kg[2]', 'cut_cylinders'];
const kResults = [['mean_torque_Nm', 'engine', 0, 0, 'Nm', 1], ['gas_cycle[1].peak_Pa', 'cylinder', 1, 0, 'kPa', 1e-3],
                  ['valve_cycle[1,1].seating_speed_m_s', 'valve', 1, 1, 'm/s', 1]];

export async function openModule() { return new FakeModule(); }

export class FakeModule {
  constructor() {
    Object.assign(this, {watched: [], input: Float64Array.of(0, 1, 0, 0, 0), sampled: [], edgeRows: [], ticks: 0,
                         turned_deg: 0, text: ''});
  }

  moduleFacts() { return {version: 'none', simd: false, max_samples: 4096}; }
  putFile() {}

  load(path, text) {
    const line = text.split('\n').findIndex((words) => /\bbad\b/.test(words)) + 1;
    if (line > 0) return {errors: [{line, text: `${path}:${line}: <img src=x onerror=alert(1)> is bad`}], warnings: []};
    this.text = text;
    return {errors: [], warnings: []};
  }

  lift_m(own_deg) {
    const half_deg = numberOf(this.text, 'cam intake', 'half_angle_deg') ?? 60;
    const place = (((own_deg - 460) / 2 + 540) % 360 - 180) / half_deg;
    return Math.abs(place) < 1 ? 0.009 * (1 - place * place) ** 2 : 0;
  }

  facts() {
    const cam_deg = Array.from({length: 361}, (_, i) => i - 180);
    const lift_m = cam_deg.map((deg) => this.lift_m(460 + 2 * deg));
    const bore_m = (numberOf(this.text, 'crank', 'bore_mm') ?? 86) * 1e-3;
    return {
      name: valueOf(this.text, 'engine', 'name') ?? 'fake', path: 'fake.ini', breathes: false, has_pressure: true,
      has_starter: false, has_triggers: true, rated_rpm: 3000, max_rpm: null,
      crank: {bore_m, crank_radius_m: 0.043, rod_length_m: 0.143, pin_offset_m: 0, compression_ratio: 10,
              stroke_m: 0.086, swept_m3: Math.PI / 4 * bore_m ** 2 * 0.086, clearance_m3: 5e-5},
      cylinders: kFiring_deg.map((firing_deg) => ({firing_deg, bank_deg: 0})), firing_order: [1, 2],
      trains: [{name: 'intake', port: 'intake', valves_per_cylinder: 1, max_lift_m: 0.009, full_lift_deg: 460,
                rocker: 'ratio', base_circle_m: 0.018, clearance_m: 0, seat_m: 0, cam_deg, cam_lift_m: lift_m,
                profile_m: lift_m.map((lift) => 0.018 + lift), can_redline: true}],
      wheels: [{name: 'crank', shaft: 'crank'}],
    };
  }

  keys() { return []; }

  start({tick_us, speed_rpm, crank_deg}) {
    if (!(tick_us > 0)) return {errors: [{line: 0, text: 'no tick'}], warnings: []};
    Object.assign(this, {tick_s: tick_us * 1e-6, ticks: 0, start_deg: crank_deg, turned_deg: 0});
    this.input[0] = speed_rpm * Math.PI / 30;
    return {errors: [], warnings: [], settling_cycles: 1, ticks_per_cycle: 1};
  }

  inputs() { return kInputs.map((name) => ({name, base: name.replace(/\[.*/, '')})); }
  inputValues() { return this.input; }
  results() {
    return kResults.map(([name, of, first, second, shown_unit, shown_per_unit]) => (
      {name, base: name.replace(/\d/g, '#'), of, first, second, shown_unit, shown_per_unit, meaning: name}));
  }
  resultValues() { return Float64Array.of(42, 5e6, 0.2); }
  channels() { return kChannels.map((name) => ({name})); }
  watch(names) {
    if (names.some((name) => !kChannels.includes(name))) return {errors: [{line: 0, text: 'unknown'}], columns: []};
    this.watched = names;
    return {errors: [], columns: this.columns()};
  }
  columns() { return ['time_s', 'crank_deg', ...this.watched]; }
  cycles() { return Math.floor((this.start_deg + this.turned_deg) / 720) - Math.floor(this.start_deg / 720); }

  step(ticks, every) {
    this.sampled = [];
    this.edgeRows = [];
    for (let i = 0; i < ticks; ++i) {
      const before = Math.floor(this.turned_deg / 90);
      this.turned_deg += this.input[0] * 180 / Math.PI * this.tick_s;
      ++this.ticks;
      const after = Math.floor(this.turned_deg / 90);
      if (after !== before) this.#edge(after);
      if (every > 0 && this.ticks % every === 0) this.sampled.push(...this.row());
    }
    return ticks;
  }

  #edge(number) {
    const late_s = (this.turned_deg - 90 * number) / (this.input[0] * 180 / Math.PI);
    this.edgeRows.push(this.ticks * this.tick_s - late_s, 0, number % 2);
  }

  row() {
    const deg = ((this.start_deg + this.turned_deg) % 720 + 720) % 720;
    return [this.ticks * this.tick_s, deg, ...this.watched.map((name) => this.#value(name, deg))];
  }

  #value(name, deg) {
    if (name === 'speed_rad_s') return this.input[0];
    const cylinder = Number(/(\d)\]/.exec(name)?.[1] ?? 1);
    const own_deg = (deg - kFiring_deg[cylinder - 1] + 720) % 720;
    const lift_m = this.lift_m(own_deg);
    if (name.includes('pressure')) return 1e5 + 5e6 * Math.exp(-((own_deg / 60) ** 2));
    if (name.includes('theoretical')) return lift_m;
    if (name.includes('lift')) return lift_m * 0.999;
    if (name.includes('regime')) return lift_m > 0 ? 1 : 3;
    if (name.includes('train_N')) return 40e3 * lift_m;
    return 100 + 50 * Math.sin(deg * Math.PI / 180);
  }

  now() { return Float64Array.from(this.row()); }
  samples() { return Float64Array.from(this.sampled); }
  edges() { return Float64Array.from(this.edgeRows); }

  hash() { return {errors: [], hash: '0x0123456789ABCDEF', ticks: 1, mean_torque_Nm: 1}; }

  /// The onset goes with the root of the spring rate.
  redline() {
    this.onset_rpm = 1000 * Math.sqrt(numberOf(this.text, 'valve intake', 'spring_N_per_mm') ?? 49);
    this.speed_rpm = 500;
    return {errors: [], from_rpm: 500, to_rpm: 12000, step_rpm: 500, speeds: 23};
  }
  redlineStep() {
    this.speed_rpm += 500;
    if (this.speed_rpm > 12000)
      return {ended: true, separation_rpm: this.onset_rpm, bounce_rpm: this.onset_rpm + 500, seating_rpm: null};
    const beyond = Math.max(0, this.speed_rpm - this.onset_rpm) * 1e-7;
    return {ended: false, part: 'sweep', done: this.speed_rpm / 500, of: 24, speed_rpm: this.speed_rpm,
            results: {separation_gap_m: beyond, bounce_m: beyond / 2}};
  }
}
