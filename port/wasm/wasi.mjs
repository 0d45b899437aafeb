// What an image of this port asks of its host, of WASI's preview 1: text out, an end. For Node and for pages alike.
//
// What belongs here: the functions that wasi-libc imports for printf and _Exit. What does not: files, clocks, random
// numbers, which the images do not use.

const kBadDescriptor = 8;  // __WASI_ERRNO_BADF

/// Thrown by proc_exit: ends the module's run.
export class Exit extends Error {
  constructor(status) {
    super(`ended with status ${status}`);
    this.status = status;
  }
}

/// Runs an image to its end and returns its exit status. `write` is called with each piece of text that it prints.
export function runImage(module, write) {
  let memory = null;
  const decoder = new TextDecoder();
  const wasi = {
    proc_exit(status) {
      throw new Exit(status);
    },
    fd_write(descriptor, pieces, count, written) {
      if (descriptor !== 1 && descriptor !== 2) return kBadDescriptor;
      const view = new DataView(memory.buffer);
      let bytes = 0;
      for (let i = 0; i < count; ++i) {
        const size = view.getUint32(pieces + 8 * i + 4, true);
        const piece = new Uint8Array(memory.buffer, view.getUint32(pieces + 8 * i, true), size);
        write(decoder.decode(piece, {stream: true}));
        bytes += size;
      }
      view.setUint32(written, bytes, true);
      return 0;
    },
    fd_close: () => kBadDescriptor,
    fd_seek: () => kBadDescriptor,
    fd_fdstat_get: () => kBadDescriptor,
  };
  const {exports} = new WebAssembly.Instance(module, {wasi_snapshot_preview1: wasi});
  memory = exports.memory;
  try {
    exports._start();
  } catch (end) {
    if (end instanceof Exit) return end.status;
    throw end;
  }
  return 0;
}
