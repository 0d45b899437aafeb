// Sliders that edit the engine file: the text is the one truth, a slider shows and changes one value in it.

import {element, slider} from './dom.mjs';
import {namesOf, numberOf, valueOf, withoutKey, withValue} from './engine_text.mjs';
import {ofStep} from './numbers.mjs';

/// Of each train: [section's kind, key, label, unit].
const kOfTrain = [
  ['valve', 'spring_N_per_mm', 'Spring rate', 'N/mm'],
  ['valve', 'spring_preload_N', 'Spring preload', 'N'],
  ['rocker', 'clearance_mm', 'Clearance', 'mm'],
  ['valve', 'valve_g', 'Valve mass', 'g'],
  ['valve', 'train_damping_ratio', 'Train damping', ''],
  ['cam', 'half_angle_deg', 'Cam half angle', 'deg'],
  ['cam', 'max_lift_mm', 'Cam lift', 'mm'],
];
const kOfCrank = [
  ['crank', 'bore_mm', 'Bore', 'mm'],
  ['crank', 'stroke_mm', 'Stroke', 'mm'],
  ['crank', 'rod_length_mm', 'Rod length', 'mm'],
];

/// {section, key, label, unit, value, min, max, step} of all that a text has.
export function slidersOf(text) {
  const list = kOfCrank.map(([section, key, label, unit]) => ({group: 'Crank', section, key, label, unit}));
  for (const name of namesOf(text, 'valve'))
    for (const [kind, key, label, unit] of kOfTrain)
      list.push({group: `Train ${name}`, section: `${kind} ${name}`.trim(), key, label, unit});
  return list.flatMap((one) => {
    const value = numberOf(text, one.section, one.key);
    return value === null ? [] : [{...one, value, ...rangeOf(one.key, value)}];
  });
}

/// Half to one and a half of the value in round steps; clearance and damping from 0.
export function rangeOf(key, value) {
  const least = {clearance_mm: 0.5, train_damping_ratio: 0.2}[key];
  if (least !== undefined) {
    const max = Math.max(least, 2 * value);
    return {min: 0, max, step: max / 100};
  }
  const step = 10 ** Math.floor(Math.log10(Math.abs(value) || 1) - 1.5);
  const least_value = key === 'half_angle_deg' ? Math.max(10, 0.7 * value) : 0.5 * value;
  return {min: round(least_value, step), max: round(1.5 * value, step), step};
}

function round(value, step) { return Number((Math.round(value / step) * step).toPrecision(12)); }

/// The text with a slider's value. A rod's ratio that a source has rounded holds for its own crank only.
export function slid(text, {section, key, step}, value) {
  const changed = withValue(text, section, key, ofStep(value, step));
  const ofRod = section === 'crank' && (key === 'stroke_mm' || key === 'rod_length_mm');
  if (!ofRod || valueOf(changed, 'crank', 'rod_ratio') === null) return changed;
  return withoutKey(changed, 'crank', 'rod_ratio', 'of another crank');
}

export class Sliders {
  constructor(root, textOf, changed) {
    Object.assign(this, {root, textOf, changed, shown: [], names: ''});
  }

  /// Makes the sliders of a text that has others than before; sets those that are there.
  setText(text) {
    const list = slidersOf(text);
    const names = list.map(({section, key}) => `${section}.${key}`).join();
    if (names !== this.names) this.#make(list);
    this.names = names;
    list.forEach(({value}, i) => {
      if (this.shown[i].get() !== value) this.shown[i].set(value);
    });
  }

  #make(list) {
    this.shown = list.map((one) => slider({...one, change: (value) => this.changed(slid(this.textOf(), one, value))}));
    const groups = [...new Set(list.map(({group}) => group))];
    this.root.replaceChildren(...groups.map((group) => element(
      'fieldset', {class: 'sliders'}, element('legend', {}, group),
      ...this.shown.filter((_, i) => list[i].group === group).map(({node}) => node))));
  }
}
