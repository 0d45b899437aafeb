import assert from 'node:assert/strict';
import {test} from 'node:test';

import {toCsv} from '../../port/wasm/page/csv.mjs';
import {ofStep, readable, shownAs} from '../../port/wasm/page/numbers.mjs';
import {toVcd} from '../../port/wasm/page/vcd.mjs';

test('numbers in CSV give the same doubles back', () => {
  const rows = Float64Array.of(0.1, 1 / 3, -1e-300, 6.02e23, 0, 5e-324);
  const lines = toCsv(['a', 'b'], rows).trimEnd().split('\n');
  assert.deepEqual(lines.slice(1).flatMap((line) => line.split(',').map(Number)), [...rows]);
});

test('a name is one field and no formula', () => {
  assert.equal(toCsv(['=1+1', 'valve[1,1].lift_m', 'a"b'], new Float64Array(0)),
               '\'=1+1,"valve[1,1].lift_m","a""b"\n');
});

test('a value change dump has changes only, in rising time, and names that viewers take', () => {
  const vcd = toVcd('my engine </script>', ['crank', 'cam intake'], [
    {time_s: 0, wire: 0, level: 0}, {time_s: 0, wire: 1, level: 1}, {time_s: 1e-6, wire: 0, level: 1},
    {time_s: 2e-6, wire: 0, level: 1}, {time_s: 3e-6, wire: 0, level: 0}], 4e-6);
  assert.equal(vcd, '$version crankloop $end\n$timescale 1 ns $end\n$scope module my_engine___script_ $end\n' +
    '$var wire 1 ! crank $end\n$var wire 1 " cam_intake $end\n$upscope $end\n$enddefinitions $end\n' +
    '#0\n0!\n1"\n#1000\n1!\n#3000\n0!\n#4000\n');
});

test('people read four digits', () => {
  assert.equal(readable(194.5678), '194.6');
  assert.equal(readable(-0.0123456), '−0.01235');
  assert.equal(readable(123456.7), '123457');
  assert.equal(readable(NaN), '–');
  assert.deepEqual(shownAs('cylinder[1].pressure_Pa'), {factor: 1e-3, unit: 'kPa'});
  assert.deepEqual(shownAs('peak_pressure_Pa[3]'), {factor: 1e-3, unit: 'kPa'});
  assert.equal(shownAs('valve[1,2].lift_m').unit, 'mm');
  assert.equal(shownAs('mean_speed_rad_s').unit, 'rpm');
  assert.equal(shownAs('residual_ratio').unit, '');
  assert.equal(ofStep(0.30000000000000004, 0.01), '0.3');
  assert.equal(ofStep(86.5, 0.5), '86.5');
});
