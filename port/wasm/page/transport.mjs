// Time: run and pause, one tick, one cycle, how fast; and the keys of all that.

import {byId, element, setText} from './dom.mjs';
import {listenToKeys} from './keyboard.mjs';
import {rateName, rateOfSlider, sliderOfRate} from './pacing.mjs';

export function connectTransport(session, controls, bench) {
  connectRate(session);
  session.on('paused', (paused) => setText(byId('run'), paused ? 'Run' : 'Pause'));
  const actions = new Map([...actionsOfTime(session), ...actionsOfEngine(session, controls, bench)]);
  listenToKeys(actions, byId('key-list'), element);
  const buttons = {run: ' ', tick: '.', cycle: ',', restart: '0', keep: 'a', forget: 'g'};
  for (const [id, key] of Object.entries(buttons)) byId(id).addEventListener('click', actions.get(key).act);
}

function connectRate(session) {
  const rate = byId('rate');
  rate.addEventListener('input', () => session.setRate(rateOfSlider(Number(rate.value))));
  session.on('rate', (to) => {
    rate.value = String(sliderOfRate(to));
    setText(byId('rate-name'), rateName(to));
  });
}

function actionsOfTime(session) {
  const faster = (by) => session.setRate(rateOfSlider(sliderOfRate(session.rate) + by));
  return [
    [' ', {shown: 'space', words: 'pause and run', act: () => session.setPaused(!session.paused)}],
    ['.', {words: 'one tick', act: () => session.step(1)}],
    [',', {words: 'to the end of the cycle', act: () => session.step(0, true)}],
    ['0', {words: 'from crank angle 0', act: () => session.setSettings({crank_deg: 0})}],
    ['[', {words: 'slower', act: () => faster(-5)}],
    [']', {words: 'faster', act: () => faster(5)}],
  ];
}

function actionsOfEngine(session, controls, bench) {
  const cylinders = Array.from({length: 9}, (_, i) => [String(i + 1), {act: () => session.setCylinder(i + 1)}]);
  Object.assign(cylinders[0][1], {shown: '1 … 9', words: 'cylinder'});
  return [
    ['ArrowUp', {shown: '↑', words: 'higher speed', act: () => controls.changeSpeed(1.05)}],
    ['ArrowDown', {shown: '↓', words: 'lower speed', act: () => controls.changeSpeed(1 / 1.05)}],
    ['f', {words: 'crank free or held', act: () => controls.toggleFree()}],
    ['s', {words: 'starter', act: () => controls.toggleStarter()}],
    ['c', {words: 'cut the shown cylinder', act: () => controls.toggleCut(session.cylinder)}],
    ['v', {words: 'valve lift enlarged', act: () => bench.enlargeNext()}],
    ['a', {words: 'keep this run to compare with', act: () => session.keep()}],
    ['g', {words: 'no comparison', act: () => session.forget()}],
    ['?', {words: 'these keys', act: () => { byId('keys').open = !byId('keys').open; }}],
    ...cylinders,
  ];
}
