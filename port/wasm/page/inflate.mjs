// Deflated bytes (RFC 1951) as they were: the page's modules are compressed, and a browser's own decompression is newer
// than its WebAssembly.

const kLengthBase = [3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115,
  131, 163, 195, 227, 258];
const kLengthBits = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0];
const kDistanceBase = [1, 2, 3, 4, 5, 7, 9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025, 1537, 2049,
  3073, 4097, 6145, 8193, 12289, 16385, 24577];
const kDistanceBits = [0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12,
  12, 13, 13];
const kOrderOfLengths = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
const kMaxCodeBits = 15;

/// Bits from the lowest of each byte on; beyond the end an error.
class Bits {
  constructor(bytes) { Object.assign(this, {bytes, at: 0, held: 0, count: 0}); }

  take(count) {
    while (this.count < count) {
      if (this.at >= this.bytes.length) throw new Error('deflated bytes end too early');
      this.held |= this.bytes[this.at++] << this.count;
      this.count += 8;
    }
    const value = this.held & ((1 << count) - 1);
    this.held >>>= count;
    this.count -= count;
    return value;
  }

  toByte() {
    this.held = 0;
    this.count = 0;
  }
}

/// A canonical Huffman code by the lengths of its words: how many words of each length, symbols in the words' order.
function codeOf(lengths) {
  const counts = new Uint16Array(kMaxCodeBits + 1);
  for (const length of lengths) ++counts[length];
  counts[0] = 0;
  const starts = new Uint16Array(kMaxCodeBits + 2);
  for (let i = 1; i <= kMaxCodeBits; ++i) starts[i + 1] = starts[i] + counts[i];
  const symbols = new Uint16Array(lengths.length);
  lengths.forEach((length, symbol) => { if (length > 0) symbols[starts[length]++] = symbol; });
  return {counts, symbols};
}

function symbolOf(bits, {counts, symbols}) {
  let word = 0;
  let first = 0;
  let index = 0;
  for (let length = 1; length <= kMaxCodeBits; ++length) {
    word |= bits.take(1);
    const count = counts[length];
    if (word - first < count) return symbols[index + word - first];
    index += count;
    first = (first + count) << 1;
    word <<= 1;
  }
  throw new Error('deflated bytes have a word that is none');
}

function fixedCodes() {
  const lengths = Array.from({length: 288}, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8));
  return {literals: codeOf(lengths), distances: codeOf(new Array(30).fill(5))};
}

function writtenCodes(bits) {
  const literals = bits.take(5) + 257;
  const distances = bits.take(5) + 1;
  const count = bits.take(4) + 4;
  const lengthsOfLengths = new Array(19).fill(0);
  for (let i = 0; i < count; ++i) lengthsOfLengths[kOrderOfLengths[i]] = bits.take(3);
  const code = codeOf(lengthsOfLengths);
  const lengths = [];
  while (lengths.length < literals + distances) {
    const symbol = symbolOf(bits, code);
    if (symbol < 16) lengths.push(symbol);
    else if (symbol === 16) lengths.push(...new Array(3 + bits.take(2)).fill(lengths.at(-1)));
    else lengths.push(...new Array(symbol === 17 ? 3 + bits.take(3) : 11 + bits.take(7)).fill(0));
  }
  return {literals: codeOf(lengths.slice(0, literals)), distances: codeOf(lengths.slice(literals))};
}

/// Grows as it is filled.
class Output {
  constructor(size) { Object.assign(this, {bytes: new Uint8Array(size), size: 0}); }

  room(count) {
    if (this.size + count <= this.bytes.length) return;
    const larger = new Uint8Array(2 * (this.size + count));
    larger.set(this.bytes.subarray(0, this.size));
    this.bytes = larger;
  }
  put(byte) {
    this.room(1);
    this.bytes[this.size++] = byte;
  }
  repeat(distance, length) {
    if (distance > this.size) throw new Error('deflated bytes point before their begin');
    this.room(length);
    for (let i = 0; i < length; ++i, ++this.size) this.bytes[this.size] = this.bytes[this.size - distance];
  }
}

function copyStored(bits, output) {
  bits.toByte();
  const length = bits.take(8) | bits.take(8) << 8;
  bits.take(8);
  bits.take(8);
  for (let i = 0; i < length; ++i) output.put(bits.take(8));
}

function copyCoded(bits, output, {literals, distances}) {
  for (;;) {
    const symbol = symbolOf(bits, literals);
    if (symbol === 256) return;
    if (symbol < 256) {
      output.put(symbol);
      continue;
    }
    const length = kLengthBase[symbol - 257] + bits.take(kLengthBits[symbol - 257]);
    const place = symbolOf(bits, distances);
    output.repeat(kDistanceBase[place] + bits.take(kDistanceBits[place]), length);
  }
}

/// Throws an Error for what is not deflated.
export function inflate(bytes) {
  const bits = new Bits(bytes);
  const output = new Output(4 * bytes.length);
  for (let isLast = false; !isLast;) {
    isLast = bits.take(1) === 1;
    const kind = bits.take(2);
    if (kind === 0) copyStored(bits, output);
    else if (kind === 1) copyCoded(bits, output, fixedCodes());
    else if (kind === 2) copyCoded(bits, output, writtenCodes(bits));
    else throw new Error('deflated bytes have a block that is none');
  }
  return output.bytes.slice(0, output.size);
}

/// A module as it is compiled, out of the page's bytes of it: deflated, or as it is.
export function moduleBytes(buffer) {
  const bytes = new Uint8Array(buffer);
  const isModule = [0x00, 0x61, 0x73, 0x6d].every((byte, i) => bytes[i] === byte);
  return isModule ? bytes : inflate(bytes);
}
