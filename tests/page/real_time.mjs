// real_time.mjs PROGRAM MODULES ENGINES [TICK_US]: how much faster than real time the page's module steps each sample
// engine under Node, beside the program in the same run. A figure is the lower quartile of batches, because
// other programs interrupt some; the program's the least of some calls. The program runs at a held speed: the page's
// free crank is the same engine with more to do.

import {spawnSync} from 'node:child_process';
import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';

import {openedModule} from './modules_of.mjs';

const [program, modules, engines, tick_us = '50'] = process.argv.slice(2);
const kHostCalls = 5;
const kBatches = 301;
const kBatchTicks = 200;  // short: a busy machine interrupts long ones

/// `run` has the median of batches that are longer than the page's.
function hostTime_ns(file, real) {
  const words = ['run', join(engines, file), '--tick-us', tick_us, '--real', real, '--no-warnings'];
  const times = Array.from({length: kHostCalls}, () => {
    const {stdout, stderr} = spawnSync(program, words, {encoding: 'utf8'});
    const found = /^wall_time_per_tick = (\S+) ns/m.exec(stdout);
    if (!found) throw new Error(`${words.join(' ')}: ${stderr}`);
    return Number(found[1]);
  });
  return Math.min(...times);
}

async function pageTime_ns(file, real, free) {
  const engine = await openedModule(modules);
  for (const name of readdirSync(engines)) {
    if (name.endsWith('.csv')) engine.putFile(name, readFileSync(join(engines, name), 'utf8'));
  }
  refuse(engine.load(file, readFileSync(join(engines, file), 'utf8')));
  const start = {tick_us: Number(tick_us), in_double: real === 'double', free, speed_rpm: engine.facts().rated_rpm, crank_deg: 0};
  refuse(engine.start(start));
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

console.log(`tick ${tick_us} us, rated speed; ns a tick, times the host's, times real time`);
for (const file of readdirSync(engines).filter((name) => name.endsWith('.ini'))) {
  for (const real of ['float', 'double']) {
    const host_ns = hostTime_ns(file, real);
    const cells = [`${file} ${real}`.padEnd(34), `host ${host_ns.toFixed(0)}`.padStart(11)];
    for (const free of [false, true]) {
      const page_ns = await pageTime_ns(file, real, free);
      cells.push(`${free ? 'free' : 'held'} ${page_ns.toFixed(0)} ` +
                 `(${(page_ns / host_ns).toFixed(2)}, x${(Number(tick_us) * 1000 / page_ns).toFixed(0)})`.padStart(15));
    }
    console.log(cells.join('  '));
  }
}
