// real_time.mjs PROGRAM PAGE_TICK MODULES ENGINES [TICK_US]: how much faster than real time the page's module steps each
// sample engine under Node, beside the same engine compiled for this processor (target crankloop_page_tick), both in one
// run, at a held speed and with the crank free. `run` is the program's own scene, which has no trigger wheels. A figure is
// the lower quartile of batches, because other programs interrupt some; the host's the least of some calls.

import {spawnSync} from 'node:child_process';
import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';

import {openedModule} from './modules_of.mjs';

const [program, page_tick, modules, engines, tick_us = '50'] = process.argv.slice(2);
const kHostCalls = 3;
const kBatches = 301;
const kBatchTicks = 200;  // short: a busy machine interrupts long ones

function leastOf(command, words, pattern) {
  const times = Array.from({length: kHostCalls}, () => {
    const {stdout, stderr} = spawnSync(command, words, {encoding: 'utf8'});
    const found = pattern.exec(stdout);
    if (!found) throw new Error(`${words.join(' ')}: ${stderr}`);
    return Number(found[1]);
  });
  return Math.min(...times);
}

/// `run` has the median of batches that are longer than the page's.
function runTime_ns(file, real) {
  const words = ['run', join(engines, file), '--tick-us', tick_us, '--real', real, '--no-warnings'];
  return leastOf(program, words, /^wall_time_per_tick = (\S+) ns/m);
}

function hostTime_ns(file, real, crank) { return leastOf(page_tick, [join(engines, file), real, crank, tick_us], /^(\S+)$/m); }

async function pageTime_ns(file, real, crank) {
  const engine = await openedModule(modules);
  for (const name of readdirSync(engines)) {
    if (name.endsWith('.csv')) engine.putFile(name, readFileSync(join(engines, name), 'utf8'));
  }
  refuse(engine.load(file, readFileSync(join(engines, file), 'utf8')));
  refuse(engine.start({tick_us: Number(tick_us), in_double: real === 'double', free: crank === 'free',
                       speed_rpm: engine.facts().rated_rpm, crank_deg: 0}));
  engine.step(100 * kBatchTicks, 0);
  const batches = Array.from({length: kBatches}, () => {
    const begin_ms = performance.now();
    engine.step(kBatchTicks, 0);
    return (performance.now() - begin_ms) * 1e6 / kBatchTicks;
  });
  return batches.sort((a, b) => a - b)[kBatches >> 2];
}

function refuse({errors}) {
  if (errors.length > 0) throw new Error(errors.map(({text}) => text).join('\n'));
}

console.log(`tick ${tick_us} us, from rated speed; ns a tick: the host's, the page's, and that over the host's`);
console.log('| | `run` | held: host | page | | free: host | page | | times real time |');
console.log('| --- | --- | --- | --- | --- | --- | --- | --- | --- |');
for (const file of readdirSync(engines).filter((name) => name.endsWith('.ini'))) {
  for (const real of ['float', 'double']) {
    const cells = [`${file.replace('.ini', '')}, ${real}`, runTime_ns(file, real).toFixed(0)];
    let slowest_ns = 0;
    for (const crank of ['held', 'free']) {
      const host_ns = hostTime_ns(file, real, crank);
      const page_ns = await pageTime_ns(file, real, crank);
      cells.push(host_ns.toFixed(0), page_ns.toFixed(0), (page_ns / host_ns).toFixed(2));
      slowest_ns = Math.max(slowest_ns, page_ns);
    }
    console.log(`| ${cells.join(' | ')} | ${(Number(tick_us) * 1000 / slowest_ns).toFixed(0)} |`);
  }
}
