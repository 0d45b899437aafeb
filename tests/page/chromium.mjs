// Chromium without a head, driven by its debugging protocol over a pipe: no package, no port.

import {spawn, spawnSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync, statSync} from 'node:fs';
import {availableParallelism, loadavg, tmpdir} from 'node:os';
import {join} from 'node:path';

/// The browser's command, or null where there is none.
export function chromiumCommand() {
  const names = process.env.CRANKLOOP_CHROMIUM ? [process.env.CRANKLOOP_CHROMIUM] : ['chromium', 'chromium-browser'];
  return names.find((name) => spawnSync(name, ['--version'], {stdio: 'ignore'}).status === 0) ?? null;
}

export class Browser {
  static async start(flags = []) {
    const browser = new Browser(flags);
    const {targetInfos} = await browser.send('Target.getTargets');
    const page = targetInfos.find(({type}) => type === 'page');
    const {sessionId} = await browser.send('Target.attachToTarget', {targetId: page.targetId, flatten: true});
    browser.sessionId = sessionId;
    for (const domain of ['Page', 'Runtime', 'Log']) await browser.tell(`${domain}.enable`);
    await browser.tell('Target.setAutoAttach', {autoAttach: true, waitForDebuggerOnStart: false, flatten: true});
    return browser;
  }

  constructor(flags) {
    this.profile = mkdtempSync(join(tmpdir(), 'crankloop-page-'));
    this.process = spawn(chromiumCommand(), [
      '--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--hide-scrollbars', '--mute-audio',
      `--user-data-dir=${this.profile}`, '--remote-debugging-pipe', ...flags, 'about:blank',
    ], {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.asked = 0;
    this.answers = new Map();
    this.complaints = [];  // errors and warnings of the console, exceptions, refusals by the policy
    this.workers = new Set();  // sessions of those that run
    this.rest = '';
    this.process.stdio[4].setEncoding('utf8').on('data', (text) => this.#read(text));
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.asked;
    this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + '\0');
    return new Promise((resolve, reject) => this.answers.set(id, {resolve, reject, method}));
  }

  /// To the page.
  tell(method, params = {}) { return this.send(method, params, this.sessionId); }

  #read(text) {
    const messages = (this.rest + text).split('\0');
    this.rest = messages.pop();
    for (const message of messages) this.#take(JSON.parse(message));
  }

  #take({id, result, error, method, params}) {
    const waiting = this.answers.get(id);
    this.answers.delete(id);
    if (waiting && error) waiting.reject(new Error(`${waiting.method}: ${error.message}`));
    if (waiting) waiting.resolve(result);
    if (method === 'Target.attachedToTarget' && params.targetInfo.type === 'worker') this.#watch(params.sessionId);
    if (method === 'Target.detachedFromTarget') this.workers.delete(params.sessionId);
    if (method === 'Runtime.exceptionThrown')
      this.complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type))
      this.complaints.push(params.args.map(({value}) => value).join(' '));
    if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level))
      this.complaints.push(`${params.entry.text} ${params.entry.url ?? ''}`);
  }

  /// A worker's exceptions are complaints too.
  #watch(sessionId) {
    this.workers.add(sessionId);
    this.send('Runtime.enable', {}, sessionId).catch(() => {});  // it may have ended
  }

  /// Memory in use by scripts of the page and its workers, after a collection; arrays' and modules' memory is in it.
  async memory_MB() {
    let bytes = 0;
    for (const session of [this.sessionId, ...this.workers]) {
      await this.send('HeapProfiler.collectGarbage', {}, session);
      const {usedSize, embedderHeapUsedSize = 0, backingStorageSize = 0} = await this.send('Runtime.getHeapUsage', {},
                                                                                           session);
      bytes += usedSize + embedderHeapUsedSize + backingStorageSize;
    }
    return bytes / 1e6;
  }

  /// Processor time of the processes that run pages and their workers, since they began: whatever else the machine does.
  async processorTime_s() {
    const {processInfo} = await this.send('SystemInfo.getProcessInfo');
    return processInfo.filter(({type}) => type === 'renderer').reduce((sum, {cpuTime}) => sum + cpuTime, 0);
  }

  async open(url, {width = 1366, height = 900, dark = false, scale = 1, mobile = false} = {}) {
    await this.tell('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: scale, mobile});
    await this.tell('Emulation.setEmulatedMedia', {
      features: [{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]});
    await this.tell('Page.navigate', {url});
    await this.until(`location.href === ${JSON.stringify(url)} && document.readyState === 'complete'`);
  }

  /// The value of an expression in the page; a promise is waited for.
  async evaluate(expression) {
    const {result, exceptionDetails} = await this.tell('Runtime.evaluate', {
      expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /// Waits until an expression holds.
  async until(expression, most_ms = 20000) {
    const end_ms = Date.now() + most_ms;
    while (!await this.evaluate(expression)) {
      if (Date.now() > end_ms) throw new Error(`not within ${most_ms} ms: ${expression}`);
      await pause(30);
    }
  }

  /// The bytes of a file that a click on a button offers, which the browser puts into a folder.
  async downloaded(id, folder, name) {
    await this.send('Browser.setDownloadBehavior', {behavior: 'allow', downloadPath: folder});
    await this.evaluate(`document.getElementById('${id}').click()`);
    const file = join(folder, name);
    const isThere = () => existsSync(file) && statSync(file).size > 0;
    for (let i = 0; i < 400 && !isThere(); ++i) await pause(25);
    if (!isThere()) {
      const said = await this.evaluate("document.getElementById('download-state').textContent");
      throw new Error(`${name} did not come within 10 s; the page says "${said}"`);
    }
    await pause(100);  // for the rest of it
    const bytes = readFileSync(file);
    rmSync(file);
    return bytes;
  }

  async screenshot({whole = true} = {}) {
    const {cssContentSize: {width, height}} = await this.tell('Page.getLayoutMetrics');
    const clip = whole ? {x: 0, y: 0, width, height, scale: 1} : undefined;
    const {data} = await this.tell('Page.captureScreenshot', {captureBeyondViewport: whole, clip});
    return Buffer.from(data, 'base64');
  }

  async stop() {
    this.process.stdio[3].on('error', () => {});
    const ended = new Promise((resolve) => this.process.once('exit', resolve));
    this.send('Browser.close').catch(() => {});
    const timer = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    await ended;
    clearTimeout(timer);
    rmSync(this.profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 100});
  }
}

/// Programs that wait for each processor, at least 1: a limit in seconds is one of a machine that does nothing else.
export function waiting() { return Math.max(1, loadavg()[0] / availableParallelism()); }

export function pause(ms) { return new Promise((resolve) => setTimeout(resolve, ms)); }
