// What moves: the cylinder's picture, all cylinders, scopes and live numbers, once for each frame of the display.

import {byId, setText} from './dom.mjs';
import {faultWords} from './faults.mjs';
import {FiringPicture} from './firing.mjs';
import {betweenAngles, strokeName, wrapped} from './mechanism.mjs';
import {readable} from './numbers.mjs';
import {Picture} from './picture.mjs';
import {Scopes} from './scopes.mjs';
import {pressureName} from './watched.mjs';

const kEnlarged = [1, 3, 10];
const kNumbersEvery_ms = 120;
const kMostDegPerFrame = 45;  // beyond it a hair over the scopes would only flicker

export class Bench {
  #isFirst = true;

  constructor(session, palette) {
    Object.assign(this, {session, palette, redline: null, fresh: true, asked: false, numbers_ms: 0, most_Pa: 5e6,
                         enlarged: 1});
    this.picture = new Picture(byId('picture'));
    this.firing = new FiringPicture(byId('firing'), (cylinder) => session.setCylinder(cylinder));
    this.scopes = new Scopes(byId);
    const select = byId('enlarged');
    select.addEventListener('change', () => this.#enlarge(Number(select.value)));
    session.on('engine', ({facts}) => {
      this.picture.setEngine(facts);
      this.firing.setEngine(facts);
      this.freshCycle = true;
    });
    session.on('frame', () => {
      this.asked = false;
      this.fresh = true;
    });
    for (const kind of ['cycle', 'kept', 'cylinder']) session.on(kind, () => { this.freshCycle = true; });
    const frame = () => {
      this.#frame();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /// At once: paper does not wait for a frame.
  redraw() {
    this.fresh = this.freshCycle = this.redrawAll = true;
    if (this.session.frame !== null) this.#draw();
  }

  enlargeNext() { this.#enlarge(kEnlarged[(kEnlarged.indexOf(this.enlarged) + 1) % kEnlarged.length]); }

  #enlarge(by) {
    this.enlarged = by;
    byId('enlarged').value = String(by);
    this.fresh = true;
  }

  #frame() {
    const {session} = this;
    if (session.engine !== null && !this.asked) {
      this.asked = true;
      session.order({kind: 'want'});
    }
    if (session.frame !== null) this.#draw();
  }

  #draw() {
    const view = this.#viewOfFrame();
    if (this.fresh || this.picture.surface.stale || this.firing.surface.stale) this.#drawPictures(view);
    if (this.freshCycle || this.scopes.stale || (this.fresh && view.slow)) this.#drawScopes(view);
    this.#drawRedline(view);
    this.#writeNumbers(view);
    this.fresh = this.freshCycle = this.redrawAll = false;
  }

  /// All at the angle that is shown, between two ticks.
  #viewOfFrame() {
    const {now, before, share} = this.session.frame;
    const crank_deg = betweenAngles(before.get(0, 'crank_deg'), now.get(0, 'crank_deg'), share, 720);
    const value = (name) => {
      if (!now.has(name)) return NaN;
      const old = before.get(0, name);
      return old + share * (now.get(0, name) - old);
    };
    const speed_rad_s = now.has('speed_rad_s') ? value('speed_rad_s') : this.session.settings.speed_rpm * Math.PI / 30;
    const turned_deg = Math.abs(speed_rad_s) * 180 / Math.PI * this.session.rate / 60;
    return {crank_deg, value, speed_rad_s, slow: this.session.paused || turned_deg < kMostDegPerFrame};
  }

  #cylinderAngle(crank_deg) {
    const {engine, cylinder} = this.session;
    return wrapped(crank_deg - engine.facts.cylinders[cylinder - 1].firing_deg, 720);
  }

  #pressure(value, cylinder) {
    const gas_Pa = value(pressureName(cylinder, true));
    return Number.isNaN(gas_Pa) ? value(pressureName(cylinder, false)) : gas_Pa;
  }

  #drawPictures({crank_deg, value}) {
    const {facts} = this.session.engine;
    const {cylinder} = this.session;
    const pressures = facts.cylinders.map((_, i) => this.#pressure(value, i + 1));
    this.most_Pa = Math.max(0.999 * this.most_Pa, 5e5, ...pressures.filter(Number.isFinite));
    const gas = pressures.map((p) => Number.isNaN(p) ? 0 : Math.sqrt(Math.max(0, p - 1e5) / this.most_Pa));
    const trains = facts.trains.map((_, t) => trainState(this.session.frame.now, value, t + 1, cylinder));
    this.picture.draw(this.palette, {cylinder_deg: this.#cylinderAngle(crank_deg), gas: gas[cylinder - 1], trains,
                                     enlarged: this.enlarged});
    this.firing.draw(this.palette, crank_deg, gas, cylinder);
    if (this.#isFirst) performance.mark('first picture');
    this.#isFirst = false;
  }

  #drawScopes({crank_deg, slow}) {
    const {cycle, kept, current, engine, cylinder} = this.session;
    const shown = cycle !== null && cycle.rows.columns.length === current?.n ? cycle : null;
    this.scopes.draw(this.palette, {cycle: shown, kept, current, engine, cylinder,
                                    cursor_deg: slow ? crank_deg : null});
  }

  #drawRedline({speed_rad_s}) {
    if (this.redline === null) return;
    const rpm = Math.round(Math.abs(speed_rad_s) * 3 / Math.PI) * 10;
    const stale = this.redline.stale || this.redline.surfaces.some((surface) => surface.stale);
    if (!stale && !this.redrawAll && rpm === this.redlineRpm) return;
    this.redlineRpm = rpm;
    this.redline.draw(this.palette, rpm);
  }

  #writeNumbers({crank_deg, value, speed_rad_s}) {
    const now_ms = performance.now();
    if (now_ms - this.numbers_ms < kNumbersEvery_ms) return;
    this.numbers_ms = now_ms;
    const own_deg = this.#cylinderAngle(crank_deg);
    const {frame, cylinder} = this.session;
    setText(byId('live-speed'), `${readable(speed_rad_s * 30 / Math.PI)} rpm`);
    setText(byId('live-angle'), `${own_deg.toFixed(1)} deg`);
    setText(byId('live-stroke'), strokeName(own_deg));
    setText(byId('live-torque'), `${readable(value('torque_Nm'))} Nm`);
    setText(byId('live-pressure'), `${readable(1e-3 * this.#pressure(value, cylinder))} kPa`);
    setText(byId('live-time'), `${readable(frame.now.get(0, 'time_s'), 6)} s`);
    setText(byId('live-faults'), faultWords(frame.faults));
    byId('live-faults').className = frame.faults === 0 ? '' : 'error';
    const {settling_cycles} = this.session.engine;
    setText(byId('settling'), frame.cycles < settling_cycles ?
      `Settling: cycle ${frame.cycles + 1} of ${settling_cycles}.` : '');
    setText(byId('live-load'), frame.load > 0 ? `${readable(1 / frame.load, 3)} times real time` : '–');
  }
}

function trainState(now, value, train, cylinder) {
  const of = (what) => value(`valve[${train},${cylinder}].${what}`);
  const regime = `valve_forces[${train},${cylinder}].regime`;
  const lift_m = of('lift_m');
  const wanted_m = of('theoretical_lift_m');
  return {
    lift_m: Number.isNaN(lift_m) ? 0 : lift_m, wanted_m: Number.isNaN(wanted_m) ? 0 : wanted_m,
    regime: now.has(regime) ? now.get(0, regime) : NaN,
  };
}
