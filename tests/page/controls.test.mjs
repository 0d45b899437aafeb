import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {test} from 'node:test';

import {changesOf, fileName} from '../../port/wasm/page/downloads.mjs';
import {numberOf, valueOf} from '../../port/wasm/page/engine_text.mjs';
import {faultWords} from '../../port/wasm/page/faults.mjs';
import {wordsOf} from '../../port/wasm/page/figures.mjs';
import {Lines} from '../../port/wasm/page/proof_run.mjs';
import {rangeOf, slid, slidersOf} from '../../port/wasm/page/sliders.mjs';

const kEngines = new URL('../../tools/engines/', import.meta.url);
const read = (file) => readFileSync(new URL(file, kEngines), 'utf8');

test('every sample engine has its sliders, each around its value', () => {
  for (const file of readdirSync(kEngines).filter((name) => name.endsWith('.ini'))) {
    const list = slidersOf(read(file));
    assert.ok(list.length >= 3, file);
    for (const {value, min, max, step, key} of list)
      assert.ok(min <= value && value <= max && step > 0 && max - min >= 20 * step, `${file} ${key}`);
  }
  const keys = slidersOf(read('four_2000.ini')).map(({section, key}) => `${section}.${key}`);
  for (const key of ['crank.bore_mm', 'crank.stroke_mm', 'crank.rod_length_mm', 'valve intake.spring_N_per_mm',
                     'valve exhaust.spring_preload_N', 'rocker intake.clearance_mm', 'valve intake.valve_g',
                     'valve exhaust.train_damping_ratio', 'cam intake.half_angle_deg', 'cam exhaust.max_lift_mm'])
    assert.ok(keys.includes(key), key);
});

test('a slider’s value is the text’s', () => {
  const text = read('four_2000.ini');
  for (const one of slidersOf(text)) {
    const to = Number((one.min + 7 * one.step).toPrecision(6));
    assert.ok(Math.abs(numberOf(slid(text, one, to), one.section, one.key) - to) <= one.step / 10);
  }
});

test('another rod or stroke drops the ratio that a source has rounded', () => {
  const text = read('diesel_495.ini');
  const rod = slidersOf(text).find(({key}) => key === 'rod_length_mm');
  const bore = slidersOf(text).find(({key}) => key === 'bore_mm');
  assert.equal(valueOf(slid(text, rod, 200), 'crank', 'rod_ratio'), null);
  assert.equal(valueOf(slid(text, bore, 90), 'crank', 'rod_ratio'), '0.2738');
});

test('a clearance of nothing can be opened', () => {
  assert.deepEqual(rangeOf('clearance_mm', 0), {min: 0, max: 0.5, step: 0.005});
});

test('files are named after the engine’s, whatever stands in its path', () => {
  assert.equal(fileName('/some where/four_2000.ini', '.csv'), 'four_2000.csv');
  assert.equal(fileName('C:\\x\\<b>.ini', '.vcd'), '_b_.vcd');
  assert.equal(fileName('', '.ini'), 'engine.ini');
});

test('edges become changes, with each wheel’s level before its first edge', () => {
  const rows = Float64Array.of(1, 0, 1, 2, 1, 0, 2.5, 100, 1, 3, 0, 0);
  assert.deepEqual(changesOf(rows, 2), [
    {time_s: 1, wire: 0, level: 0}, {time_s: 1, wire: 1, level: 1}, {time_s: 1, wire: 0, level: 1},
    {time_s: 2, wire: 1, level: 0}, {time_s: 3, wire: 0, level: 0}]);
});

test('a result’s name in words', () => {
  assert.equal(wordsOf({name: 'mean_torque_Nm'}), 'Mean torque');
  assert.equal(wordsOf({name: 'valve_cycle[1,2].seating_speed_m_s'}), 'Seating speed');
});

test('lines out of pieces', () => {
  const lines = [];
  const reader = new Lines((line) => lines.push(line));
  for (const piece of ['gol', 'den a 0x1\ngolden b', ' 0x2\n', '45 passed, 0 failed\n']) reader.put(piece);
  assert.deepEqual(lines, ['golden a 0x1', 'golden b 0x2', '45 passed, 0 failed']);
  assert.equal(reader.last, '45 passed, 0 failed');
});

test('faults have the names of the library, bit by bit', () => {
  const header = readFileSync(new URL('../../core/include/crankloop/faults.hpp', import.meta.url), 'utf8');
  const bits = new Map([...header.matchAll(/(kFault\w+)\s*=\s*1u << (\d+)/g)].map((m) => [m[1], Number(m[2])]));
  const names = [...header.matchAll(/case (kFault\w+):\s*return "([^"]+)"/g)];
  assert.ok(names.length >= 13 && names.length === bits.size);
  for (const [, fault, name] of names) assert.equal(faultWords(2 ** bits.get(fault)), name);
  assert.equal(faultWords(0), 'none');
  assert.equal(faultWords(2 + 8), 'speed, pressure');
  assert.equal(faultWords(2 ** 30), 'unknown');
});
