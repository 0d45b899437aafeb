// The page around a fake engine, in Chromium, from a file: what a hand does, what a hostile file cannot do, no
// complaint on the console. Exit status 77, "skipped", where there is no Chromium.

import assert from 'node:assert/strict';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Browser, chromiumCommand, pause, waiting} from './chromium.mjs';
import {pageOf} from './join.mjs';

const kText = `[engine]
name = </script><img src=x onerror="document.title='caught'">
rated_rpm = 3000
[crank]
bore_mm = 86   # a comment
[cam intake]
half_angle_deg = 60
[rocker intake]
clearance_mm = 0.1
[valve intake]
spring_N_per_mm = 49
`;
const kRunning = "document.getElementById('live-time').textContent.endsWith(' s')";
const kTime = "Number(document.getElementById('live-time').textContent.split(' ')[0])";
const kEditor = "document.querySelector('#editor textarea')";

const textOf = (id) => `document.getElementById('${id}').textContent`;
const sliderOf = (label) => `[...document.querySelectorAll('#sliders .slider')].find((s) =>
  s.querySelector('label').textContent === '${label}').querySelector('input')`;
const typed = (text) => `{const area = ${kEditor}; area.value = ${JSON.stringify(text)};
  area.dispatchEvent(new Event('input'));}`;
const put = (input, value) => `{const input = ${input}; input.value = '${value}';
  input.dispatchEvent(new Event('input'));}`;

async function key(browser, text) {
  await browser.tell('Input.dispatchKeyEvent', {type: 'keyDown', key: text, text});
  await browser.tell('Input.dispatchKeyEvent', {type: 'keyUp', key: text});
}

const kStories = {
  async 'a first picture within a second, and it runs'(browser) {
    await browser.until(kRunning);
    const first_ms = await browser.evaluate("performance.getEntriesByName('first picture')[0].startTime");
    assert.ok(first_ms < 1000 * waiting(), `first picture after ${first_ms} ms`);
    const time_s = await browser.evaluate(kTime);
    await browser.until(`${kTime} > ${time_s + 0.3}`);
  },

  async 'a name is text: no element comes out of a file'(browser) {
    assert.match(await browser.evaluate(textOf('title')), /^<\/script><img src=x/);
    assert.equal(await browser.evaluate("document.querySelectorAll('img').length"), 0);
    assert.notEqual(await browser.evaluate('document.title'), 'caught');
  },

  async 'pause, one tick, one cycle, by keys'(browser) {
    await key(browser, ' ');
    await pause(1000);
    const time_s = await browser.evaluate(kTime);
    await pause(500);
    assert.equal(await browser.evaluate(kTime), time_s);
    await key(browser, '.');
    await browser.until(`${kTime} !== ${time_s}`);
    assert.ok(Math.abs(await browser.evaluate(kTime) - time_s - 50e-6) < 1.1e-5);
    await key(browser, ',');
    await browser.until(`${kTime} > ${time_s + 1e-3}`);
    await key(browser, ' ');
    await browser.until(`${kTime} > ${time_s + 0.2}`);
  },

  async 'time at 1/10 000'(browser) {
    await browser.evaluate(put("document.getElementById('rate')", 0));
    assert.equal(await browser.evaluate(textOf('rate-name')), '1/10000');
    await pause(400);
    const time_s = await browser.evaluate(kTime);
    await pause(2000);
    assert.ok(await browser.evaluate(kTime) - time_s < 1e-3);
    await browser.evaluate(put("document.getElementById('rate')", 100));
  },

  async 'a slider edits the text, keeps its comment, and leaves the run before in grey'(browser) {
    await browser.evaluate(put(sliderOf('Bore'), 90));
    await browser.until(`${kEditor}.value.includes('bore_mm = 90')`);
    assert.match(await browser.evaluate(`${kEditor}.value`), /\nbore_mm = 90 {3}# a comment\n/);
    await browser.until(`${textOf('summary')}.includes('bore 90 mm')`);
  },

  async 'the redline moves with the spring'(browser) {
    const onset = "JSON.parse(document.getElementById('redline-text').dataset.onsets ?? '{}').separation_rpm";
    await browser.until(`${onset} === 7000`);
    await browser.evaluate(put(sliderOf('Spring rate'), 64));
    await browser.until(`${onset} === 8000`);
    assert.match(await browser.evaluate(textOf('redline-text')), /floats from 8000 rpm \(\+1000\)/);
  },

  async 'a bad text shows its error beside its line and changes nothing'(browser) {
    const good = await browser.evaluate(`${kEditor}.value`);
    const time_s = await browser.evaluate(kTime);
    await browser.evaluate(typed(good.replace('[cam intake]', 'bad = 1\n[cam intake]')));
    await browser.until("document.querySelectorAll('#editor-problems li').length === 1");
    assert.match(await browser.evaluate(textOf('editor-problems')), /:6: <img src=x onerror=alert\(1\)> is bad/);
    assert.equal(await browser.evaluate("document.querySelector('#editor .flags span').textContent"),
                 '<img src=x onerror=alert(1)> is bad');
    assert.equal(await browser.evaluate("document.querySelector('#editor .lines b').textContent"), '6\n');
    assert.equal(await browser.evaluate("document.querySelectorAll('img').length"), 0);
    await browser.until(`${kTime} > ${time_s + 0.3}`);
    await browser.evaluate(typed(good));
    await browser.until("document.querySelectorAll('#editor-problems li').length === 0");
  },

  async 'the other cylinder, enlarged lift, and every control has a label'(browser) {
    await key(browser, '2');
    await key(browser, 'v');
    assert.equal(await browser.evaluate("document.getElementById('cylinder').value"), '2');
    assert.equal(await browser.evaluate("document.getElementById('enlarged').value"), '3');
    assert.equal(await browser.evaluate(`[...document.querySelectorAll('input, select, textarea')].filter((one) =>
      one.labels.length === 0 && !one.hasAttribute('aria-label')).length`), 0);
  },

  async 'the hash of a file is shown with the command that prints it'(browser) {
    await browser.evaluate("document.getElementById('hash').click()");
    await browser.until(`${textOf('hash-text')}.startsWith('0x0123456789ABCDEF')`);
    assert.match(await browser.evaluate(textOf('hash-text')), /crankloop run fake\.ini --hash --rpm 3000/);
  },

  async 'what a reader takes along: text, cycle, edges, picture'(browser, url, folder) {
    const time_s = await browser.evaluate(kTime);
    await browser.until(`${kTime} > ${time_s + 0.3}`);  // a whole cycle of the cylinder that is shown now
    const engine = (await browser.downloaded('get-engine', folder, 'fake.ini')).toString();
    assert.equal(engine, await browser.evaluate(`${kEditor}.value`));
    const csv = (await browser.downloaded('get-csv', folder, 'fake.csv')).toString().trimEnd().split('\n');
    assert.match(csv[0], /^time_s,crank_deg,speed_rad_s,torque_Nm,/);
    const angles = csv.slice(1).map((row) => Number(row.split(',')[1]));
    assert.ok(angles.length > 700 && angles.every((deg, i) => i === 0 || deg > angles[i - 1]));  // 3000 rpm, 50 us
    const vcd = (await browser.downloaded('get-vcd', folder, 'fake.vcd')).toString();
    assert.match(vcd, /^\$version crankloop \$end\n\$timescale 1 ns \$end\n\$scope module __script__img_src_x/);
    const times = [...vcd.matchAll(/^#(\d+)$/gm)].map((m) => Number(m[1]));
    assert.ok(times.length > 20 && times.every((ns, i) => i === 0 || ns > times[i - 1]));
    const png = await browser.downloaded('get-picture', folder, 'fake.png');
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    assert.ok(png.readUInt32BE(16) > 1000 && png.length > 20000, `${png.readUInt32BE(16)} wide, ${png.length} bytes`);
  },

  async 'a phone has one column and nothing beside it'(browser, url) {
    for (const dark of [false, true]) {
      await browser.open(url, {width: 390, height: 844, mobile: true, dark});
      await browser.until(kRunning);
      assert.equal(await browser.evaluate('document.documentElement.scrollWidth'), 390);
    }
  },
};

async function withoutWebAssembly(url) {
  const browser = await Browser.start();
  try {
    await browser.tell('Page.addScriptToEvaluateOnNewDocument', {source: 'delete globalThis.WebAssembly'});
    await browser.open(url);
    await browser.until("document.getElementById('refusal')?.hidden === false");
    assert.match(await browser.evaluate(textOf('refusal-words')), /no WebAssembly/);
    assert.match(await browser.evaluate(textOf('refusal-file')), /bore_mm = 86/);
    assert.deepEqual(browser.complaints, []);
    console.log('ok  without WebAssembly it says so');
  } finally {
    await browser.stop();
  }
}

async function main() {
  if (chromiumCommand() === null) process.exit(77);
  const folder = mkdtempSync(join(tmpdir(), 'crankloop-page-'));
  const file = join(folder, 'page.html');
  const fake = new URL('fake_module.mjs', import.meta.url).href;
  const empty = Buffer.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0]).toString('base64');
  writeFileSync(file, pageOf({source: {path: 'fake.ini', text: kText, files: []}, module: empty,
                              golden: [['a', '0x1']], replaced: {'module.mjs': fake}}));
  const url = pathToFileURL(file).href;
  try {
    await allStories(url, folder);
    await withoutWebAssembly(url);
  } finally {
    rmSync(folder, {recursive: true});
  }
}

async function allStories(url, folder) {
  const browser = await Browser.start();
  try {
    await browser.open(url);
    for (const [name, story] of Object.entries(kStories)) {
      await story(browser, url, folder);
      assert.equal(await browser.evaluate(textOf('failure')), '', name);
      assert.deepEqual(browser.complaints, [], name);
      console.log(`ok  ${name}`);
    }
  } finally {
    await browser.stop();
  }
}

await main();
