// A cycle's samples by column name: one place that knows where a column stands.

export class Rows {
  /// columns: names; data: flat rows.
  constructor(columns, data) {
    this.columns = columns;
    this.data = data;
    this.n = columns.length;
    this.at = new Map(columns.map((name, i) => [name, i]));
  }

  get count() { return this.data.length / this.n; }
  has(name) { return this.at.has(name); }
  get(row, name) { return this.data[row * this.n + this.at.get(name)]; }
  list(name) {
    const c = this.at.get(name);
    return Float64Array.from({length: this.count}, (_, i) => this.data[i * this.n + c]);
  }
}
