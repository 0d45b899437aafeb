// A recorded cycle as CSV: a header of names, a row per tick, numbers with the digits that give the same double back.

/// columns: names; rows: a flat list, row by row.
export function toCsv(columns, rows) {
  const lines = [columns.map(field).join(',')];
  for (let i = 0; i + columns.length <= rows.length; i += columns.length)
    lines.push(Array.from(rows.subarray(i, i + columns.length), String).join(','));
  return lines.join('\n') + '\n';
}

/// Quoted where a reader would take it for more than one field; a table program must not take a name for a formula.
function field(name) {
  const safe = /^[=+\-@\t\r]/.test(name) ? `'${name}` : name;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}
