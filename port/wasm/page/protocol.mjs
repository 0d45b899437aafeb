// The messages between page and workers: each kind with the fields that it must have. A message that is not of the
// list is a defect and throws where it arrives.

const kNumber = (v) => typeof v === 'number' && Number.isFinite(v);
const kText = (v) => typeof v === 'string';
const kTruth = (v) => typeof v === 'boolean';
const kList = (v) => Array.isArray(v);
const kBytes = (v) => v instanceof ArrayBuffer;
const kRows = (v) => v instanceof Float64Array;
const kObject = (v) => typeof v === 'object' && v !== null;
const orNull = (is) => (v) => v === null || is(v);

/// To the worker that runs the engine, and to that of the redline (boot, redline) and of the proof (prove).
export const kOrders = {
  boot: {bytes: kBytes, double_bytes: orNull(kBytes), files: kList},
  load: {id: kNumber, path: kText, text: kText, settings: kObject},
  settings: {id: kNumber, settings: kObject},
  input: {base: kText, value: kNumber},
  cylinder: {cylinder: kNumber},
  rate: {rate: kNumber},
  pause: {paused: kTruth},
  step: {ticks: kNumber, cycle: kTruth},
  want: {},
  edges: {id: kNumber},
  hash: {id: kNumber, run: kObject},
  redline: {id: kNumber, path: kText, text: kText, train: kText},
  stop: {},
  prove: {bytes: kBytes},
};

export const kReports = {
  ready: {facts: kObject},
  engine: {id: kNumber, facts: kObject, inputs: kList, values: kRows, columns: kList, results: kList, warnings: kList,
           settings: kObject, took_ms: kNumber, settling_cycles: kNumber},
  refused: {id: kNumber, errors: kList},
  frame: {now: kRows, before: kRows, share: kNumber, partial: kRows, restarted: kTruth, cycle: orNull(kObject),
          cycles: kNumber, load: kNumber, faults: kNumber, columns: kList},
  edges: {id: kNumber, rows: kRows, end_s: kNumber},
  hash: {id: kNumber, answer: kObject},
  redline_begun: {id: kNumber, search: kObject},
  redline_speed: {id: kNumber, step: kObject},
  redline_ended: {id: kNumber, onsets: kObject},
  golden: {name: kText, hash: kText},
  proven: {summary: kText},
  failed: {words: kText},
};

/// The message itself where it is one of `kinds`; throws with what is wrong.
export function checked(message, kinds) {
  const fields = Object.hasOwn(kinds, message?.kind) ? kinds[message.kind] : null;
  if (fields === null) throw new TypeError(`no message of this kind: ${String(message?.kind)}`);
  for (const [name, is] of Object.entries(fields)) {
    if (!is(message[name])) throw new TypeError(`message ${message.kind}: field ${name} is ${String(message[name])}`);
  }
  return message;
}
