// Runs the self-check, a program of its own for WASI, and reads what it prints.

import {runImage} from '../wasi.mjs';

/// Calls golden(name, hash) for each line "golden NAME HASH"; answers the last line, "N passed, M failed".
export async function prove(bytes, golden) {
  const lines = new Lines((line) => {
    const found = /^golden (\S+) (0x[0-9A-Fa-f]+)$/.exec(line);
    if (found) golden(found[1], found[2]);
  });
  runImage(await WebAssembly.compile(bytes), (text) => lines.put(text));
  return lines.last;
}

/// Whole lines out of pieces of text.
export class Lines {
  constructor(take) { Object.assign(this, {take, rest: '', last: ''}); }

  put(text) {
    const lines = (this.rest + text).split('\n');
    this.rest = lines.pop();
    for (const line of lines) {
      this.take(line);
      if (line !== '') this.last = line;
    }
  }
}
