// The engine's module as an object: module.h in JavaScript, and nothing more. Texts are copied in and out; views of
// numbers are made anew for each call, because the memory may have grown.

const kWriter = new TextEncoder();
const kReader = new TextDecoder();

/// bytes: of the module; doubleBytes: () => those of its second part, which is asked for when arithmetic in double is.
/// One instance is one engine.
export async function openModule(bytes, doubleBytes) {
  const module = await WebAssembly.compile(bytes);
  const imports = {
    env: {emscripten_notify_memory_growth() {}},
    wasi_snapshot_preview1: {
      proc_exit(status) { throw new Error(`the module ended with status ${status}: a defect`); },
    },
    placeholder: {},
  };
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    if (from === 'placeholder') imports.placeholder[name] = () => { throw new Error('double is not there: a defect'); };
  }
  const {exports} = await WebAssembly.instantiate(module, imports);
  exports._initialize();
  return new EngineModule(exports, doubleBytes);
}

export class EngineModule {
  constructor(exports, doubleBytes) { Object.assign(this, {exports, doubleBytes, hasDouble: false}); }

  /// The second part puts its functions into the table of the first.
  #needDouble() {
    if (this.hasDouble) return;
    new WebAssembly.Instance(new WebAssembly.Module(this.doubleBytes()), {primary: this.exports});
    this.hasDouble = true;
  }

  moduleFacts() { return this.#answer(this.exports.page_facts_of_module()); }
  putFile(name, text) { this.#withTexts([name, text], (...at) => this.exports.page_put_file(...at)); }

  /// {errors, warnings}, each a list of {line, text}.
  load(name, text) { return this.#answerTo('page_load', [name, text]); }
  facts() { return this.#answer(this.exports.page_facts()); }
  keys() { return this.#answer(this.exports.page_keys()); }

  start({tick_us, in_double, free, speed_rpm, crank_deg}) {
    if (in_double) this.#needDouble();
    return this.#answer(this.exports.page_start(tick_us, in_double ? 1 : 0, free ? 1 : 0, speed_rpm, crank_deg));
  }
  inputs() { return this.#answer(this.exports.page_inputs()); }
  inputValues(count) { return this.#numbers(this.exports.page_input_values(), count); }
  channels() { return this.#answer(this.exports.page_channels()); }
  columns() { return this.#answer(this.exports.page_columns()); }
  watch(names) { return this.#answerTo('page_watch', [names.join('\n')]); }

  step(ticks, every) { return this.exports.page_step(ticks, every); }
  samples(columns) {
    const count = this.exports.page_sample_count();
    return this.#numbers(this.exports.page_samples(), count * columns);
  }
  now(columns) { return this.#numbers(this.exports.page_now(), columns); }
  edges() { return this.#numbers(this.exports.page_edges(), 3 * this.exports.page_edge_count()); }
  cycles() { return this.exports.page_cycles(); }
  results() { return this.#answer(this.exports.page_results()); }
  resultValues(count) { return this.#numbers(this.exports.page_result_values(), count); }

  /// free: over some seconds, else over some cycles.
  hash({tick_us, in_double, free, speed_rpm, cycles, seconds}) {
    if (in_double) this.#needDouble();
    if (free) return this.#answer(this.exports.page_hash_free(tick_us, in_double ? 1 : 0, speed_rpm, seconds));
    return this.#answer(this.exports.page_hash(tick_us, in_double ? 1 : 0, speed_rpm, cycles));
  }
  redline(train, from_rpm, to_rpm) {
    this.#needDouble();
    return this.#withTexts([train], (...at) => this.#answer(this.exports.page_redline(...at, from_rpm, to_rpm)));
  }
  redlineStep() { return this.#answer(this.exports.page_redline_step()); }

  #answerTo(name, texts) { return this.#withTexts(texts, (...at) => this.#answer(this.exports[name](...at))); }

  /// Calls with address and size of each text in the module's memory.
  #withTexts(texts, call) {
    const rooms = [];
    try {
      const places = texts.flatMap((text) => {
        const bytes = kWriter.encode(text);
        const room = this.exports.page_take(Math.max(1, bytes.length));
        if (room === 0) throw new Error('the module has no memory left');
        rooms.push(room);
        new Uint8Array(this.exports.memory.buffer, room, bytes.length).set(bytes);
        return [room, bytes.length];
      });
      return call(...places);
    } finally {
      rooms.forEach((room) => this.exports.page_give(room));
    }
  }

  #answer(at) {
    const bytes = new Uint8Array(this.exports.memory.buffer);
    return JSON.parse(kReader.decode(bytes.subarray(at, bytes.indexOf(0, at))));
  }

  #numbers(at, count) {
    return at === 0 || count === 0 ? new Float64Array(0) : new Float64Array(this.exports.memory.buffer, at, count);
  }
}
