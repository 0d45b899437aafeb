// soak.mjs PROGRAM ENGINES MINUTES: the page of a four-cylinder engine with gas exchange in Chromium for so long, with a
// change of the engine each half minute: what its scripts hold and what its process has resident, after collections.
// Fails where that grows, where anything stands on the console, and where the engine stops.

import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Browser, pause} from './chromium.mjs';

const [program, engines, minutes] = process.argv.slice(2);
const kEvery_ms = 30000;
const kFirst = 4;  // weighings until caches are full
const textOf = (id) => `document.getElementById('${id}').textContent`;
const kTime_s = `Number(${textOf('live-time')}.split(' ')[0])`;

/// Of the processes that draw and run pages, where the system tells.
async function resident_MB(browser) {
  const {processInfo} = await browser.send('SystemInfo.getProcessInfo');
  let kB = 0;
  for (const {type, id} of processInfo) {
    if (type !== 'renderer') continue;
    kB += Number(/^VmRSS:\s*(\d+) kB$/m.exec(readFileSync(`/proc/${id}/status`, 'utf8'))[1]);
  }
  return kB / 1e3;
}

/// Bore and crank change with each call, and come back.
async function change(browser, number) {
  await browser.evaluate(`{const bore = [...document.querySelectorAll('#sliders .slider')].find((s) =>
    s.querySelector('label').textContent === 'Bore').querySelector('input[type=number]');
    bore.value = '${number % 2 === 0 ? 86 : 85}'; bore.dispatchEvent(new Event('change'));}`);
  if (number % 4 === 3) await browser.tell('Input.dispatchKeyEvent', {type: 'keyDown', key: 'f', text: 'f'});
}

async function soak(browser) {
  await browser.until(`${textOf('live-time')}.endsWith(' s')`);
  await browser.evaluate('document.activeElement.blur()');
  const weighed = [];
  for (let i = 0; i * kEvery_ms <= minutes * 60000; ++i) {
    await change(browser, i);
    await pause(kEvery_ms);
    const time_s = await browser.evaluate(kTime_s);
    await browser.until(`${kTime_s} !== ${time_s}`);
    const scripts_MB = await browser.memory_MB();
    weighed.push({scripts_MB, resident_MB: await resident_MB(browser)});
    console.log(`${((i + 1) * kEvery_ms / 60000).toFixed(1)} min: scripts ${scripts_MB.toFixed(1)} MB, ` +
                `resident ${weighed[i].resident_MB.toFixed(1)} MB`);
    assert.deepEqual(browser.complaints, []);
    assert.equal(await browser.evaluate(textOf('failure')), '');
  }
  return weighed;
}

/// The largest of the last half against the largest of the first.
function growth(weighed, key) {
  const list = weighed.slice(Math.min(kFirst, weighed.length >> 1)).map((one) => one[key]);
  const middle = list.length >> 1;
  const before = Math.max(...list.slice(0, middle + 1));
  const after = Math.max(...list.slice(middle));
  return {before, after};
}

const folder = mkdtempSync(join(tmpdir(), 'crankloop-page-'));
const page = join(folder, 'page.html');
const {status, stderr} = spawnSync(program, ['page', join(engines, 'four_2000.ini'), '--out', page], {encoding: 'utf8'});
assert.equal(status, 0, stderr);
const browser = await Browser.start();
try {
  await browser.open(pathToFileURL(page).href);
  const weighed = await soak(browser);
  const scripts = growth(weighed, 'scripts_MB');
  const resident = growth(weighed, 'resident_MB');
  assert.ok(scripts.after <= 1.05 * scripts.before + 1, `scripts: ${JSON.stringify(scripts)}`);
  assert.ok(resident.after <= 1.05 * resident.before + 5, `resident: ${JSON.stringify(resident)}`);
  console.log(`${minutes} minutes, ${weighed.length} changes: scripts at most ${scripts.before.toFixed(1)} MB in the first ` +
              `half and ${scripts.after.toFixed(1)} in the second, resident ${resident.before.toFixed(0)} and ` +
              `${resident.after.toFixed(0)} MB; no line on the console`);
} finally {
  await browser.stop();
  rmSync(folder, {recursive: true, force: true});
}
