// The numbers of the last cycle: the engine's as tiles, the shown cylinder's and its valves' as tables.

import {element, setText} from './dom.mjs';
import {readable, shownAs} from './numbers.mjs';

/// Names that need other words, or that say what another one says.
const kWords = {
  peak_pressure_deg: 'Peak pressure at', trapped_kg: 'Trapped gas', trapped_air_kg: 'Trapped air',
  residual_ratio: 'Residual gas', exhaust_K: 'Exhaust gas', excess_air_ratio: 'Lambda', cycle_blow_by_kg: 'Blow-by',
  start_deg: 'Burn start', duration_deg: 'Burn duration', knock_deg: 'Knock at', power_W: 'Power, indicated',
};
const kLeftOut = ['peak_Pa', 'peak_deg', 'energy_defect_J'];
const kOfFreeCrank = ['mean_speed_rad_s', 'least_speed_rad_s', 'largest_speed_rad_s'];

function plainOf({name}) { return name.replace(/^.*\./, '').replace(/\[[^\]]*\]/g, ''); }

/// "mean_torque_Nm" -> "Mean torque": what stands before the unit, in words.
export function wordsOf(result) {
  const plain = plainOf(result);
  if (Object.hasOwn(kWords, plain)) return kWords[plain];
  const words = plain.replace(/_(Nm|N|Pa|m_s2|m_s|rad_s|kg_s|kg|rad|deg|m|K|J|W|rpm|ratio|s)$/, '')
    .replaceAll('_', ' ');
  return words[0].toUpperCase() + words.slice(1);
}

export class Figures {
  constructor(tiles, table) {
    this.tiles = tiles;
    this.table = table;
    this.cells = [];
  }

  /// results: page_results() of module.h; facts: page_facts().
  setEngine(all, facts, cylinder, isFree) {
    const leftOut = isFree ? kLeftOut : [...kLeftOut, ...kOfFreeCrank];
    const results = all.map((result) => leftOut.includes(plainOf(result)) ? {...result, of: ''} : result);
    this.cells = [];
    const tileOf = (result, i) => result.of === 'engine' ? [this.#tile(result, i)] : [];
    this.tiles.replaceChildren(...results.flatMap(tileOf));
    this.table.replaceChildren(...this.#cylinderRows(results, cylinder), ...this.#valveRows(results, facts, cylinder));
  }

  #cell(result, index, tag = 'span') {
    const cell = element(tag, {class: 'number'}, '–');
    this.cells.push({cell, index, factor: shownAs(result.name).factor, text: ''});
    return cell;
  }

  #tile(result, index) {
    return element('div', {title: result.meaning}, element('dt', {}, wordsOf(result)),
                   element('dd', {class: 'value'}, this.#cell(result, index), ' ',
                           element('span', {class: 'unit'}, shownAs(result.name).unit)));
  }

  #cylinderRows(results, cylinder) {
    const rowOf = (result, i) => element('tr', {title: result.meaning}, element('th', {scope: 'row'}, wordsOf(result)),
                                         this.#cell(result, i, 'td'), element('td', {}, shownAs(result.name).unit));
    const rows = results.flatMap((result, i) => result.of === 'cylinder' && result.first === cylinder ?
      [rowOf(result, i)] : []);
    return rows.length === 0 ? [] : [tableOf(`Cylinder ${cylinder}`, ['', 'value', 'unit'], rows)];
  }

  #valveRows(results, facts, cylinder) {
    const of = new Map();
    results.forEach((result, i) => {
      if (result.of !== 'valve' || result.second !== cylinder) return;
      if (!of.has(result.base)) of.set(result.base, []);
      of.get(result.base)[result.first - 1] = [result, i];
    });
    const rows = [...of.values()].map((list) => {
      const [first] = list.find((entry) => entry !== undefined);
      return element('tr', {title: first.meaning}, element('th', {scope: 'row'}, wordsOf(first)),
                     ...list.map(([result, i]) => this.#cell(result, i, 'td')),
                     element('td', {}, shownAs(first.name).unit));
    });
    const names = facts.trains.map((train) => train.name);
    return rows.length === 0 ? [] : [tableOf(`Valves of cylinder ${cylinder}`, ['', ...names, 'unit'], rows)];
  }

  show(values) {
    for (const {cell, index, factor} of this.cells) setText(cell, readable(values[index] * factor));
  }
}

function tableOf(caption, heads, rows) {
  const numbers = heads.length - 2;
  const head = heads.map((words, i) => element('th', {scope: 'col', class: i > 0 && i <= numbers ? 'number' : null},
                                               words));
  return element('div', {class: 'table scroll'},
                 element('table', {}, element('caption', {}, caption), element('thead', {}, element('tr', {}, ...head)),
                         element('tbody', {}, ...rows)));
}
