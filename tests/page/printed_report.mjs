// printed_report.mjs PROGRAM ENGINES: reports of the program as Chromium prints them, on two sizes of paper: no page more
// than what stands in them needs. Exit status 77, "skipped", where there is no Chromium.

import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Browser, chromiumCommand} from './chromium.mjs';

const [program, engines] = process.argv.slice(2);
const kPaper_inch = {letter: [8.5, 11], A4: [8.27, 11.69]};

/// [words of the command, pages].
const kReports = [
  [['run', 'ohc_125.ini', '--free', '--from-rpm', '3000'], 3],
  [['run', 'four_2000.ini', '--free', '--from-rpm', '3000'], 3],
  [['map', 'four_2000_everything.ini', '--rpm', '1000:6000:2', '--throttle', '0.1:1:2', '--tick-us', '200'], 2],
  [['map', 'four_2000.ini', '--rpm', '1000:6000:2', '--throttle', '0.1:1:2', '--tick-us', '200'], 2],
];

async function pagesOf(browser, [paperWidth, paperHeight]) {
  const {data} = await browser.tell('Page.printToPDF', {paperWidth, paperHeight, printBackground: true});
  return Buffer.from(data, 'base64').toString('latin1').match(/\/Type\s*\/Page\b/g).length;
}

async function printsOn(browser, folder, [[command, file, ...words], pages]) {
  const report = join(folder, 'report.html');
  const {status, stderr} = spawnSync(program, [command, join(engines, file), ...words, '--report', report, '--no-warnings'],
                                     {encoding: 'utf8'});
  assert.equal(status, 0, stderr);
  await browser.tell('Page.navigate', {url: 'about:blank'});
  await browser.open(pathToFileURL(report).href);
  for (const [size, paper] of Object.entries(kPaper_inch))
    assert.equal(await pagesOf(browser, paper), pages, `${command} ${file} on ${size}`);
  console.log(`ok  ${command} ${file}: ${pages} pages`);
}

if (chromiumCommand() === null) {
  console.log('skipped: no chromium');
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), 'crankloop-report-'));
const browser = await Browser.start();
try {
  for (const report of kReports) await printsOn(browser, folder, report);
} finally {
  await browser.stop();
  rmSync(folder, {recursive: true, force: true});
}
