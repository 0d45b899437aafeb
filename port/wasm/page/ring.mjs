// A ring of rows of fixed size: the newest rows, however long the page runs.

export class Ring {
  /// capacity rows of columns numbers each; allocated once.
  constructor(columns, capacity) {
    this.columns = columns;
    this.capacity = capacity;
    this.data = new Float64Array(columns * capacity);
    this.written = 0;  // rows since the start
  }

  get size() { return Math.min(this.written, this.capacity); }

  clear() { this.written = 0; }

  /// Takes `count` rows out of a flat list that has them from `from` on.
  push(rows, count = 1, from = 0) {
    const skip = Math.max(0, count - this.capacity);  // they would be overwritten at once
    for (let i = skip; i < count; ++i) {
      const source = (from + i) * this.columns;
      const target = ((this.written + i) % this.capacity) * this.columns;
      for (let c = 0; c < this.columns; ++c) this.data[target + c] = rows[source + c];
    }
    this.written += count;
  }

  /// Row 0 is the oldest that is kept.
  get(row, column) {
    if (row < 0 || row >= this.size) return NaN;
    return this.data[((this.written - this.size + row) % this.capacity) * this.columns + column];
  }
}
