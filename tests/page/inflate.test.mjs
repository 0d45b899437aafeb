// Inflating, against Node's own zlib.

import assert from 'node:assert/strict';
import {test} from 'node:test';
import {constants, deflateRawSync} from 'node:zlib';

import {inflate} from '../../port/wasm/page/inflate.mjs';

/// Bytes between noise and repetition.
function bytesOf(count, kinds) {
  let state = 12345;
  return Uint8Array.from({length: count}, (_, i) => {
    state = (Math.imul(state, 1103515245) + 12345) >>> 0;
    return i % 7 < 3 ? i % 13 : (state >>> 16) % kinds;
  });
}

test('gives back what zlib deflated, in every kind of block', () => {
  for (const count of [0, 1, 2, 300, 70000, 300000]) {
    for (const kinds of [1, 4, 256]) {
      const bytes = bytesOf(count, kinds);
      for (const options of [{level: 0}, {level: 1}, {level: 9}, {strategy: constants.Z_FIXED}, {strategy: constants.Z_HUFFMAN_ONLY}])
        assert.deepEqual(inflate(deflateRawSync(bytes, options)), bytes);
    }
  }
});

test('refuses what ends too early, points before its begin, or is no block', () => {
  const whole = deflateRawSync(bytesOf(5000, 256));
  for (const end of [0, 1, 10, whole.length - 2]) assert.throws(() => inflate(whole.subarray(0, end)), Error);
  assert.throws(() => inflate(Uint8Array.of(7)), /block that is none/);
  assert.throws(() => inflate(Uint8Array.of(0x03 | 0x00, 0x02, 0x00, 0x00)), Error);
});
