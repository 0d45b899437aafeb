// same_numbers.mjs PROGRAM MODULES ENGINES: the page's modules under Node beside the program: the hash of every bit of
// every sample engine in float and double, the redline, the lines of errors of bad files. Exit status 77, "skipped",
// where the modules are not there.

import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
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

const hashes = new Map();
function hashOfProgram(file, real, tick_us) {
  const words = ['run', join(engines, file), '--hash', '--real', real, '--tick-us', String(tick_us), '--no-warnings'];
  const key = words.join(' ');
  if (!hashes.has(key)) hashes.set(key, /^hash = (\S+)/m.exec(run(...words).stdout)[1]);
  return hashes.get(key);
}

async function sameHashes() {
  const engine = await opened();
  for (const file of kFiles) {
    assert.deepEqual(engine.load(file, textOf(file)).errors, []);
    for (const real of ['float', 'double']) {
      for (const tick_us of [50, 100]) {
        const run = {tick_us, in_double: real === 'double', speed_rpm: engine.facts().rated_rpm, cycles: 2};
        const {errors, hash} = engine.hash(run);
        assert.deepEqual(errors, []);
        assert.equal(hash, hashOfProgram(file, real, tick_us), `${file} ${real} ${tick_us} us`);
      }
    }
  }
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

if (!hasModules(modules)) {
  console.log(`skipped: there is no module in ${modules}; preset page makes it`);
  process.exit(77);
}
for (const story of [sameHashes, sameRedline, sameErrors]) {
  await story();
  console.log(`ok  ${story.name}`);
}
