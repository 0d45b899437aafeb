// The page: puts its parts together and draws at the display's rate. Each frame asks the worker once, when it has
// answered the last one.

import {Bench} from './bench.mjs';
import {byId, element, setText} from './dom.mjs';
import {Controls} from './controls.mjs';
import {fileName, offerCsv, offerEngine, offerPicture, offerVcd} from './downloads.mjs';
import {Editor} from './editor.mjs';
import {Figures} from './figures.mjs';
import {readable} from './numbers.mjs';
import {Palette} from './palette.mjs';
import {hashOfFile, ProofView} from './proof_view.mjs';
import {RedlineView} from './redline_view.mjs';
import {Session} from './session.mjs';
import {Sliders} from './sliders.mjs';
import {bytesBlock, canRunModules, jsonBlock, textBlock, workerOf} from './source.mjs';
import {connectTransport} from './transport.mjs';

function main() {
  const source = jsonBlock('engine-source');
  setText(byId('title'), source.path);
  if (!canRunModules()) {
    refuse('This browser has no WebAssembly with exceptions, in which the engine runs. Below is the engine’s file; ' +
           'a newer browser, or the program crankloop, runs it.', source.text);
    return;
  }
  const newWorker = () => workerOf(textBlock('worker-text'));
  const boot = {kind: 'boot', bytes: bytesBlock('engine-module').buffer,
                double_bytes: bytesBlock('engine-double')?.buffer ?? null, files: source.files};
  const engineWorker = newWorker();
  const session = new Session(engineWorker, source);
  const palette = new Palette(() => bench.redraw());
  const bench = new Bench(session, palette);
  const controls = new Controls(byId('controls'), session);
  engineWorker.onerror = (event) => showFailure(event.message);
  session.on('failed', ({words}) => showFailure(words));
  session.on('ready', () => session.setText(source.text));
  session.order(boot);
  connectTransport(session, controls, bench);
  connectText(session, source);
  connectHead(session);
  connectFigures(session);
  connectRedline(session, bench, newWorker, boot);
  connectDownloads(session, palette);
  connectProof(session, newWorker);
}

/// Without an engine: says why, and shows the file.
function refuse(words, text) {
  byId('app').hidden = true;
  byId('refusal').hidden = false;
  setText(byId('refusal-words'), words);
  setText(byId('refusal-file'), text);
}

function showFailure(words) {
  byId('failure').hidden = false;
  setText(byId('failure'), `The engine has stopped: ${words}. Load the page again; the text below is as it was.`);
}

function connectText(session, source) {
  const editor = new Editor(byId('editor'), (text) => session.setText(text));
  const sliders = new Sliders(byId('sliders'), () => session.text, (text) => session.setText(text));
  session.on('text', (text) => {
    editor.setText(text);
    sliders.setText(text);
    setText(byId('paper-file'), text);
  });
  byId('as-it-was').addEventListener('click', () => session.setText(source.text));
  session.on('engine', ({warnings, took_ms}) => {
    const isNewest = session.text === session.loaded;
    showProblems(editor, warnings.map((one) => ({...one, kind: 'warning'})),
                 isNewest ? `Taken: read, tables made and started in ${readable(took_ms, 2)} ms.` : '');
  });
  session.on('refused', ({errors}) => showProblems(editor, errors.map((one) => ({...one, kind: 'error'})),
                                                   'Not taken: the engine from before goes on.'));
}

/// Beside their lines, and below the editor each as a button that leads to its line.
function showProblems(editor, problems, state) {
  editor.setProblems(problems);
  byId('editor-problems').replaceChildren(...problems.map(({line, text, kind}) => element(
    'li', {class: kind}, line > 0 ? element('button', {type: 'button', onclick: () => editor.goTo(line)}, text)
                                  : text)));
  setText(byId('editor-state'), state);
}

function connectFigures(session) {
  const figures = new Figures(byId('figures'), byId('figure-tables'));
  const set = () => figures.setEngine(session.engine.results, session.engine.facts, session.cylinder,
                                      session.settings.free);
  let names = '';
  session.on('engine', ({facts, results}) => {
    const key = JSON.stringify([results.map(({name}) => name), facts.trains.map(({name}) => name),
                                session.settings.free]);
    if (key !== names) set();
    names = key;
  });
  session.on('cylinder', set);
  session.on('cycle', ({results}) => figures.show(results));
}

/// Name, summary, and which cylinder is shown.
function connectHead(session) {
  const select = byId('cylinder');
  session.on('engine', ({facts}) => {
    setText(byId('title'), facts.name);
    document.title = facts.name;
    setText(byId('summary'), summaryOf(facts));
    byId('torque-key').hidden = facts.cylinders.length === 1;
    for (const keys of document.querySelectorAll('.train-keys'))
      keys.replaceChildren(...facts.trains.map(({name}, t) => element('span', {class: `key c${t + 1}`}, name)));
    if (select.children.length !== facts.cylinders.length)
      select.replaceChildren(...facts.cylinders.map((_, i) => element('option', {value: i + 1}, `cylinder ${i + 1}`)));
    select.value = String(session.cylinder);
  });
  select.addEventListener('change', () => session.setCylinder(Number(select.value)));
  session.on('cylinder', (cylinder) => { select.value = String(cylinder); });
}

function summaryOf({crank, cylinders, firing_order, trains, breathes}) {
  const count = `${cylinders.length} ${cylinders.length === 1 ? 'cylinder' : 'cylinders'}`;
  const litres = 1e3 * crank.swept_m3 * cylinders.length;
  const valves = trains.map((train) => `${train.valves_per_cylinder} ${train.name}`).join(', ');
  return `${count}, bore ${readable(1e3 * crank.bore_m, 3)} mm, stroke ${readable(1e3 * crank.stroke_m, 3)} mm, ` +
    `${readable(litres)} L` +
    (cylinders.length > 1 ? `, firing order ${firing_order.join('-')}` : '') +
    (trains.length > 0 ? `; valves of each: ${valves}` : '') + (breathes ? '; gas exchange.' : '.');
}

/// Its worker begins when the engine runs: until then both would wait for the processor, and the picture with them.
function connectRedline(session, bench, newWorker, boot) {
  session.on('engine', ({facts}) => {
    bench.redline ??= startRedline(newWorker(), boot);
    bench.redline.setEngine(session.path, session.loaded, facts);
  });
}

function startRedline(worker, boot) {
  const view = new RedlineView(worker, {gap: byId('redline-gap'), bounce: byId('redline-bounce'),
                                        text: byId('redline-text'), train: byId('redline-train')});
  worker.onmessage = ({data}) => {
    if (data.kind === 'failed') setText(byId('redline-text'), `The search has stopped: ${data.words}`);
    else view.take(data);
  };
  worker.postMessage(boot);
  return view;
}

function connectDownloads(session, palette) {
  const say = (words) => setText(byId('download-state'), words);
  const when = (id, act, none) => byId(id).addEventListener('click', async () => {
    say(session.engine !== null && await act() !== false ? '' : none);
  });
  when('get-engine', () => offerEngine(session), '');
  when('get-csv', () => offerCsv(session), 'There is no whole cycle yet.');
  when('get-vcd', () => offerVcd(session), 'No trigger wheel has had an edge yet.');
  when('get-picture', () => offerPicture(session, [...document.querySelectorAll('figure')], palette), '');
  byId('get-engine').title = fileName(session.path, '.ini');
}

function connectProof(session, newWorker) {
  const isThere = textBlock('proof-module') !== '';
  byId('proof-golden').hidden = !isThere;
  if (isThere)
    new ProofView({button: byId('prove'), text: byId('proof-text'), body: byId('proof-body'),
                   details: byId('proof-details')}, jsonBlock('golden-hashes'), newWorker,
                  () => bytesBlock('proof-module').buffer);
  byId('hash').addEventListener('click', async () => {
    if (session.engine !== null) setText(byId('hash-text'), await hashOfFile(session));
  });
}

main();
