// double_part.mjs CALLS: the functions that only arithmetic in double needs, one a line. CALLS is what
// `wasm-opt --print-call-graph` prints. What else reaches a function keeps it in the first part: no engine in float finds
// a placeholder.

import {readFileSync} from 'node:fs';

/// How double is come to: engines by two calls and by their virtual functions, and the redline's search, which is in
/// double whatever the engine is in.
const kDoor = /(start_running|hash_held_run|hash_free_run)Id|RunningSceneId.*4tickEd$|^page_redline(_step)?$/;
const kDoors = 9;

const calls = new Map();  // function -> those that it calls
const roots = [];
const listOf = (name) => {
  if (!calls.has(name)) calls.set(name, new Set());
  return calls.get(name);
};
for (const line of readFileSync(process.argv[2], 'utf8').split('\n')) {
  const call = /^ *"(.*)" -> "([^"]*)"/.exec(line);
  const node = /^ *"([^"]*)" \[(.*)\]/.exec(line);
  if (call) listOf(call[1]).add(call[2]);
  else if (node) {
    listOf(node[1]);
    if (/rounded|gray/.test(node[2])) roots.push(node[1]);  // in the table, or exported
  }
}

const doors = [...calls.keys()].filter((name) => kDoor.test(name));
if (doors.length !== kDoors) throw new Error(`doors to double: ${doors.join(' ')}`);

function reached(from, not) {
  const found = new Set();
  const left = from.filter((name) => !not.has(name));
  while (left.length > 0) {
    const name = left.pop();
    if (found.has(name)) continue;
    found.add(name);
    for (const called of calls.get(name)) if (!not.has(called)) left.push(called);
  }
  return found;
}

const kept = reached(roots, new Set(doors));
process.stdout.write([...reached(doors, kept)].join('\n') + '\n');
