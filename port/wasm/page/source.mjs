// What the program has put into the page beside its script: data blocks, which no browser runs or shows.

import {inflate} from './inflate.mjs';

export function jsonBlock(id) { return JSON.parse(document.getElementById(id).textContent); }
export function textBlock(id) { return document.getElementById(id).textContent; }

/// Bytes of a block in base64, of a module perhaps deflated; null where the page has none.
export function bytesBlock(id) {
  const text = document.getElementById(id)?.textContent.trim() ?? '';
  if (text === '') return null;
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  const isModule = [0x00, 0x61, 0x73, 0x6d].every((byte, i) => bytes[i] === byte);
  return isModule ? bytes : inflate(bytes);
}

/// The first of some modules that this browser can run, the one with SIMD before the one without; null: none.
export function moduleOf(ids) {
  if (typeof WebAssembly !== 'object') return null;
  return ids.map(bytesBlock).find((bytes) => bytes !== null && WebAssembly.validate(bytes)) ?? null;
}

/// A worker of the page's own text.
export function workerOf(text) {
  const url = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
  const worker = new Worker(url);
  setTimeout(() => URL.revokeObjectURL(url), 10000);
  return worker;
}
