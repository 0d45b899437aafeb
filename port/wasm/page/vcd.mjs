// Trigger wheels' signals as a value change dump, as tools/crankloop/signals/vcd.cpp writes it: 1 ns, changes only.

/// wires: names; changes: [{time_s, wire, level}] in the order of time.
export function toVcd(module, wires, changes, end_s) {
  const head = ['$version crankloop $end', '$timescale 1 ns $end', `$scope module ${reference(module)} $end`];
  wires.forEach((name, i) => head.push(`$var wire 1 ${codeOf(i)} ${reference(name)} $end`));
  head.push('$upscope $end', '$enddefinitions $end');
  const body = [];
  const known = wires.map(() => null);
  let written_ns = -1;
  const at = (time_s) => {
    const ns = Math.max(written_ns, Math.round(time_s * 1e9));
    if (ns !== written_ns) body.push(`#${ns}`);
    written_ns = ns;
  };
  for (const {time_s, wire, level} of changes) {
    if (known[wire] === level) continue;
    known[wire] = level;
    at(time_s);
    body.push((level ? '1' : '0') + codeOf(wire));
  }
  at(end_s);
  return head.concat(body).join('\n') + '\n';
}

function reference(name) { return name.replace(/[^A-Za-z0-9_]/g, '_') || '_'; }

/// Printable characters, ! to ~, the lowest digit first.
function codeOf(number) {
  const digits = 94;
  let code = '';
  do {
    code += String.fromCharCode(33 + number % digits);
    number = Math.floor(number / digits);
  } while (number > 0);
  return code;
}
