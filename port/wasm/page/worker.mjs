// The worker: one text for three of them. The first runs the engine, the second searches the redline, the third proves
// the bits; each by the orders that it is sent.

import {moduleBytes} from './inflate.mjs';
import {openModule} from './module.mjs';
import {checked, kOrders} from './protocol.mjs';
import {prove} from './proof_run.mjs';
import {RedlineSearch} from './redline_search.mjs';
import {Runner} from './runner.mjs';

let module = null;
let runner = null;
let search = null;

function report(message, moved = []) { self.postMessage(message, moved); }

const kAnswers = {
  async boot({bytes, double_bytes, files}) {
    module = await openModule(moduleBytes(bytes), () => moduleBytes(double_bytes));
    for (const {name, text} of files) module.putFile(name, text);
    runner = new Runner(module, () => performance.now());
    search = new RedlineSearch(module, report);
    report({kind: 'ready', facts: module.moduleFacts()});
  },
  load({id, path, text, settings}) { answer(id, runner.open(path, text, settings)); },
  settings({id, settings}) { answer(id, runner.start(settings)); },
  input({base, value}) { runner.setInput(base, value); },
  cylinder({cylinder}) { if (runner.running) runner.watch(cylinder); },
  rate({rate}) { runner.setRate(rate); },
  pause({paused}) { runner.setPaused(paused); },
  step({ticks, cycle}) {
    if (!runner.running) return;
    if (cycle) runner.stepCycle();
    else runner.stepTicks(ticks);
  },
  want() {
    if (!runner?.running) return;
    const frame = runner.frame();
    const moved = [frame.now, frame.before, frame.partial];
    if (frame.cycle !== null) moved.push(frame.cycle.rows, frame.cycle.edges, frame.cycle.results);
    report({kind: 'frame', ...frame}, moved.map((view) => view.buffer));
  },
  edges({id}) { report({kind: 'edges', id, ...runner.allEdges()}); },
  hash({id, run}) { report({kind: 'hash', id, answer: module.hash(run)}); },
  redline({id, path, text, train}) { search.begin(id, path, text, train); },
  stop() { search?.stop(); },
  async prove({bytes}) {
    const summary = await prove(moduleBytes(bytes), (name, hash) => report({kind: 'golden', name, hash}));
    report({kind: 'proven', summary});
  },
};

function answer(id, outcome) {
  const {errors, ...engine} = outcome;
  report(errors.length > 0 ? {kind: 'refused', id, errors} : {kind: 'engine', id, ...engine});
}

let orders = Promise.resolve();  // one after the other, also those that wait
self.onmessage = ({data}) => {
  orders = orders.then(() => kAnswers[checked(data, kOrders).kind](data)).catch((error) => {
    report({kind: 'failed', words: String(error?.message ?? error)});
  });
};
