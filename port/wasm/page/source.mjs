// What the program has put into the page beside its script: data blocks, which no browser runs or shows.

export function jsonBlock(id) { return JSON.parse(document.getElementById(id).textContent); }
export function textBlock(id) { return document.getElementById(id).textContent; }

/// Bytes of a block in base64; null where the page has none.
export function bytesBlock(id) {
  const text = document.getElementById(id)?.textContent.trim() ?? '';
  if (text === '') return null;
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/// A module whose one function has a try and a catch: the engine's reader needs them.
const kWithTry = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 8, 1, 6, 0, 6, 64, 25, 11, 11];

export function canRunModules() {
  return typeof WebAssembly === 'object' && WebAssembly.validate(Uint8Array.from(kWithTry));
}

/// A worker of the page's own text.
export function workerOf(text) {
  const url = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
  const worker = new Worker(url);
  setTimeout(() => URL.revokeObjectURL(url), 10000);
  return worker;
}
