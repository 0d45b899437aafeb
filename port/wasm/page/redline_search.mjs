// The redline's search, one speed at a time between messages, so that a new engine stops the old one's search.

export class RedlineSearch {
  /// report: takes messages; later: calls a function after pending messages have been read.
  constructor(module, report, later = (call) => setTimeout(call, 0)) {
    this.module = module;
    this.report = report;
    this.later = later;
    this.id = 0;  // of the search that runs; 0: none
  }

  begin(id, path, text, train) {
    this.stop();
    const read = this.module.load(path, text);
    const search = read.errors.length > 0 ? read : this.module.redline(train, 0, 0);
    if (search.errors.length > 0) {
      this.report({kind: 'refused', id, errors: search.errors});
      return;
    }
    this.id = id;
    this.report({kind: 'redline_begun', id, search});
    this.later(() => this.#step(id));
  }

  stop() { this.id = 0; }

  #step(id) {
    if (this.id !== id) return;
    const step = this.module.redlineStep();
    if (step.ended) {
      this.id = 0;
      this.report({kind: 'redline_ended', id, onsets: step});
      return;
    }
    this.report({kind: 'redline_speed', id, step});
    this.later(() => this.#step(id));
  }
}
