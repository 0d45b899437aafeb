// The proof: the golden engines run in this browser, hash beside hash of the table; and this file's own hash.

import {element, setText} from './dom.mjs';

export class ProofView {
  /// golden: [[name, hash]...] of the table; makeWorker(): a worker of its own; bytes: () => the self-check's module.
  constructor(parts, golden, makeWorker, bytes) {
    Object.assign(this, {parts, golden, makeWorker, bytes, cells: new Map()});
    parts.button.addEventListener('click', () => this.#run());
    parts.body.replaceChildren(...golden.map(([name, hash]) => this.#row(name, hash)));
  }

  #row(name, hash) {
    const found = element('td', {class: 'hash'}, '–');
    const verdict = element('td', {}, '');
    this.cells.set(name, {hash, found, verdict, same: false});
    return element('tr', {}, element('th', {scope: 'row'}, name), element('td', {class: 'hash'}, hash), found, verdict);
  }

  #run() {
    for (const cell of this.cells.values()) {
      cell.same = false;
      setText(cell.found, '–');
      setText(cell.verdict, '');
    }
    this.parts.button.disabled = true;
    this.parts.details.open = true;
    setText(this.parts.text, 'Running the golden engines …');
    const worker = this.makeWorker();
    worker.onmessage = ({data}) => this.#take(worker, data);
    worker.postMessage({kind: 'prove', bytes: this.bytes()});
  }

  #take(worker, message) {
    if (message.kind === 'golden') this.#compare(message);
    if (message.kind !== 'proven' && message.kind !== 'failed') return;
    worker.terminate();
    this.parts.button.disabled = false;
    const same = [...this.cells.values()].filter((cell) => cell.same).length;
    setText(this.parts.text, message.kind === 'failed' ? `The proof failed: ${message.words}` :
      `${same} of ${this.cells.size} hashes are those of the table; self-check: ${message.summary}.`);
  }

  #compare({name, hash}) {
    const cell = this.cells.get(name);
    if (!cell) return;
    cell.same = BigInt(hash) === BigInt(cell.hash);
    setText(cell.found, hash);
    setText(cell.verdict, cell.same ? 'same' : 'differs');
    cell.verdict.className = cell.same ? 'good' : 'error';
  }
}

/// This file's hash as `crankloop run --hash` prints it, in words; of a free crank a second from the rated speed on.
export async function hashOfFile(session) {
  const {tick_us, in_double, free} = session.settings;
  const speed_rpm = session.engine.facts.rated_rpm;
  const {answer} = await session.ask({kind: 'hash', run: {tick_us, in_double, free, speed_rpm, cycles: 2, seconds: 1}});
  if (answer.errors.length > 0) return answer.errors.map(({text}) => text).join(' ');
  const how = free ? `--free --hash --from-rpm ${speed_rpm} --seconds 1` : `--hash --rpm ${speed_rpm} --cycles 2`;
  return `${answer.hash}, as prints: crankloop run ${session.path} ${how} --tick-us ${tick_us}` +
         (in_double ? ' --real double' : '');
}
