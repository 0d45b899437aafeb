// same_numbers.mjs PROGRAM MODULES ENGINES: the page's modules under Node beside the program: the hash of every bit of
// every sample engine in float and double, speed held and crank free, what hands do to a free crank, the redline, the
// lines of errors of bad files, the module's size. Exit status 77, "skipped", where the modules are not there.

import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

import {hasModules, openedModule} from './modules_of.mjs';

const [program, modules, engines] = process.argv.slice(2);
const kTables = readdirSync(engines).filter((name) => name.endsWith('.csv'));
const kFiles = readdirSync(engines).filter((name) => name.endsWith('.ini'));

const textOf = (name) => readFileSync(join(engines, name), 'utf8');

async function opened() {
  const engine = await openedModule(modules);
  for (const name of kTables) engine.putFile(name, textOf(name));
  return engine;
}

function run(...words) {
  const {status, stdout, stderr} = spawnSync(program, words, {encoding: 'utf8', maxBuffer: 1 << 28});
  return {status, stdout, stderr};
}

function hashOfProgram(file, {tick_us, in_double, free, speed_rpm}) {
  const how = free ? ['--free', '--from-rpm', String(speed_rpm), '--seconds', '1'] : [];
  const real = in_double ? 'double' : 'float';
  const {stdout, stderr} = run('run', join(engines, file), ...how, '--hash', '--real', real, '--tick-us',
                               String(tick_us), '--no-warnings');
  return /^hash = (\S+)/m.exec(stdout)?.[1] ?? stderr.trim();
}

async function sameHashes() {
  const engine = await opened();
  for (const file of kFiles) {
    assert.deepEqual(engine.load(file, textOf(file)).errors, []);
    for (const in_double of [false, true]) {
      for (const tick_us of [50, 100]) {
        for (const free of [false, true]) {
          const run = {tick_us, in_double, free, speed_rpm: engine.facts().rated_rpm, cycles: 2, seconds: 1};
          const {errors, hash} = engine.hash(run);
          const page = hash ?? `crankloop: ${errors[0].text}`;
          assert.equal(page, hashOfProgram(file, run).replaceAll(`${engines}/`, ''), `${file} ${JSON.stringify(run)}`);
        }
      }
    }
  }
}

/// What hands do to a free crank: [options of `run --free`, inputs of the page].
const kFreeRuns = [
  [['--from-rpm', '2500'], {}],
  [['--from-rpm', '0', '--starter'], {starter: 1}],
  [['--from-rpm', '-900'], {}],
  [['--from-rpm', '1800', '--cut', '1'], {cut_cylinders: 1}],
];
/// Columns of `run --free --csv` that the page has by the same name.
const kFreeColumns = ['torque_Nm', 'acceleration_rad_s2', 'mean_torque_Nm', 'friction_Nm', 'starter_Nm'];

function freeRunOf(file, options) {
  const {status, stdout, stderr} = run('run', join(engines, file), '--free', ...options, '--csv', '-', '--no-warnings');
  if (status !== 0) return {lines: stderr.trimEnd().split('\n').map((line) => line.replace(/^crankloop: /, ''))};
  const [head, ...rows] = stdout.trimEnd().split('\n').filter((line) => !line.startsWith('#'));
  const names = head.split(',');
  return {lines: [], rows: rows.map((row) => {
    const cells = row.split(',');
    return Object.fromEntries(names.map((name, c) => [name, Number(cells[c])]));
  })};
}

/// The page's run of as many ticks: rows by name, and by the wheels' names their levels.
function freeRunOfPage(engine, request, inputs, ticks) {
  const {errors} = engine.start({free: true, crank_deg: 0, ...request});
  if (errors.length > 0) return {lines: errors.map(({text}) => text)};
  const list = engine.inputs();
  const values = engine.inputValues(list.length);
  list.forEach(({name}, i) => { if (name in inputs) values[i] = inputs[name]; });
  const wheels = engine.facts().wheels.map((wheel, w) => [`${wheel.name}_level`, `trigger[${w + 1}].level`]);
  const columns = [['speed_rad_s', 'speed_rad_s'], ...kFreeColumns.map((name) => [name, name]), ...wheels];
  engine.watch(columns.map(([, name]) => name));
  const rows = [];
  for (let i = 0; i < ticks; ++i) {
    engine.step(1, 1);
    const [, crank_deg, ...cells] = engine.samples(2 + columns.length);
    rows.push({crank_deg, ...Object.fromEntries(columns.map(([name], c) => [name, cells[c]]))});
  }
  return {lines: [], rows};
}

/// In double the program's CSV has 12 digits; the hash has all bits.
function sameFreeRun(engine, file, real, [options, inputs]) {
  const what = `${file} ${real} ${options.join(' ')}`;
  const rounded = real === 'double' ? (x) => Number(x.toPrecision(12)) : Math.fround;
  const rpmOf = (rad_s) => rounded(rad_s * (real === 'double' ? 30 / Math.PI : Math.fround(30 / Math.PI)));
  const host = freeRunOf(file, [...options, '--seconds', '0.3', '--tick-us', '50', '--real', real]);
  const request = {tick_us: 50, in_double: real === 'double', speed_rpm: Number(options[1])};
  const page = freeRunOfPage(engine, request, inputs, host.rows?.length ?? 0);
  if (host.lines.length > 0 && options.includes('--starter')) return 0;  // an engine without one: no input either
  assert.deepEqual(page.lines, host.lines.map((line) => line.replaceAll(`${engines}/`, '')), what);
  page.rows?.forEach(({crank_deg, speed_rad_s, ...others}, i) => {
    const apart_deg = Math.abs(crank_deg - host.rows[i].crank_deg);
    assert.ok(Math.min(apart_deg, 720 - apart_deg) < 1e-9, `${what}: ${crank_deg} deg, tick ${i + 1}`);
    assert.equal(rpmOf(speed_rad_s), rounded(host.rows[i].speed_rpm), `${what}: speed, tick ${i + 1}`);
    for (const [name, value] of Object.entries(others))
      assert.equal(rounded(value), rounded(host.rows[i][name]), `${what}: ${name}, tick ${i + 1}`);
  });
  return page.rows?.length ?? 0;
}

async function sameFreeRuns() {
  const engine = await opened();
  let compared = 0;
  for (const file of kFiles) {
    engine.load(file, textOf(file));
    for (const real of ['float', 'double']) {
      for (const hands of kFreeRuns) compared += sameFreeRun(engine, file, real, hands);
    }
  }
  console.log(`    ${compared} ticks of free cranks`);
  assert.ok(compared > 1e5);
}

async function sameRedline() {
  const engine = await opened();
  engine.load('ohc_125.ini', textOf('ohc_125.ini'));
  engine.redline('intake', 0, 0);
  let last = engine.redlineStep();
  while (!last.ended) last = engine.redlineStep();
  const {stdout} = run('redline', join(engines, 'ohc_125.ini'), '--no-warnings');
  const printed = (name) => Number(new RegExp(`^${name} = (\\d+)`, 'm').exec(stdout)[1]);
  assert.equal(last.separation_rpm, printed('separation_onset'));
  assert.equal(last.bounce_rpm, printed('bounce_onset'));
  assert.equal(last.seating_rpm, printed('seating_limit'));
}

/// What a hand does to a file, and what it gets.
const kBad = [
  (text) => text.replace('bore_mm', 'boore_mm'), (text) => text.replace('bore_mm = ', 'bore_mm = -'),
  (text) => text.replace('[crank]', '[crank'), () => '', () => '\0\0', () => 'x'.repeat(3000), () => '[crank]\n',
  (text) => text.replace(/rated_rpm = .*/, 'rated_rpm = nan'), (text) => text.replace(/rated_rpm = .*/, 'rated_rpm = 1e400'),
  (text) => `<img src=x onerror=alert(1)>\n${text}`, (text) => text.replace('[crank]', '[<script>alert(1)</script>]'),
  (text) => text.replace(/file = .*/g, 'file = none.csv'), (text) => text.replace(/=.*/g, '= 1,5'),
];

async function sameErrors() {
  const engine = await opened();
  const folder = mkdtempSync(join(tmpdir(), 'crankloop-page-'));
  for (const name of kTables) writeFileSync(join(folder, name), textOf(name));
  for (const file of kFiles) {
    engine.load(file, textOf(file));
    const facts = engine.facts();
    for (const [i, spoil] of kBad.entries()) {
      writeFileSync(join(folder, file), spoil(textOf(file)));
      const {status, stderr} = run('run', join(folder, file), '--no-warnings');
      const {errors} = engine.load(file, spoil(textOf(file)));
      if (status === 0) {
        assert.deepEqual(errors, [], `${file} ${i}`);
        engine.load(file, textOf(file));
        continue;
      }
      const lines = stderr.replaceAll(`${folder}/`, '').trimEnd().split('\n').map((line) => line.replace(/^crankloop: /, ''));
      assert.deepEqual(errors.map(({text}) => text), lines, `${file} ${i}`);
      assert.deepEqual(engine.facts(), facts, 'a bad file changes nothing');
    }
  }
  rmSync(folder, {recursive: true});
}

/// What a page compiles before its first picture.
function isSmall() {
  const {size} = statSync(join(modules, 'engine.wasm'));
  assert.ok(size <= 600e3, `${size} bytes`);
}

if (!hasModules(modules)) {
  console.log(`skipped: there is no module in ${modules}; preset page makes it`);
  process.exit(77);
}
for (const story of [isSmall, sameHashes, sameFreeRuns, sameRedline, sameErrors]) {
  await story();
  console.log(`ok  ${story.name}`);
}
