// The text of an engine file, edited as text: a key's value changes where it stands, comments and order stay. The
// grammar is that of tools/crankloop/engine_file/ini_text.cpp; whether a value is good the program's reader says.

/// {kind, name, line, key, value, start, end}: each entry of a text, `start` to `end` its value within the line.
function* entriesOf(lines) {
  let kind = '';
  let name = '';
  for (let i = 0; i < lines.length; ++i) {
    const code = lines[i].slice(0, commentAt(lines[i]));
    const header = /^\s*\[\s*([\w-]+)(?:\s+([\w-]+))?\s*\]\s*$/.exec(code);
    if (header) [kind, name] = [header[1], header[2] ?? ''];
    const entry = header ? null : /^(\s*([\w-]+)\s*=\s*)(.*?)\s*$/.exec(code);
    if (!entry) continue;
    const start = entry[1].length;
    yield {kind, name, line: i, key: entry[2], value: entry[3], start, end: start + entry[3].length};
  }
}

/// A comment starts at a # at the start of the line or after a blank; in a header at any #.
function commentAt(line) {
  const from = /^\s*\[/.test(line) ? line.indexOf('#') : line.search(/(^|(?<=[ \t]))#/);
  return from < 0 ? line.length : from;
}

function isOf(entry, section) {
  const [kind, name = ''] = section.split(' ');
  return entry.kind === kind && entry.name === name;
}

/// The value of a key as it stands in the text, or null. section: "crank", "valve intake".
export function valueOf(text, section, key) {
  for (const entry of entriesOf(text.split('\n'))) {
    if (isOf(entry, section) && entry.key === key) return entry.value;
  }
  return null;
}

/// As a number; null where there is none.
export function numberOf(text, section, key) {
  const value = valueOf(text, section, key);
  const number = value === null || value === '' ? NaN : Number(value);
  return Number.isFinite(number) ? number : null;
}

/// The text with another value for a key; the same text where the key does not stand in it. A comment behind the value
/// stays in its column where there is room.
export function withValue(text, section, key, value) {
  const lines = text.split('\n');
  for (const entry of entriesOf(lines)) {
    if (!isOf(entry, section) || entry.key !== key) continue;
    lines[entry.line] = spliced(lines[entry.line], entry, value);
    return lines.join('\n');
  }
  return text;
}

function spliced(line, {start, end}, value) {
  const rest = line.slice(end);
  const blanks = /^ */.exec(rest)[0].length;
  if (blanks === rest.replace('\r', '').length) return line.slice(0, start) + value + rest;
  const room = Math.max(1, blanks - (value.length - (end - start)));
  return line.slice(0, start) + value + ' '.repeat(room) + rest.slice(blanks);
}

/// The text with a key as a comment, with a reason.
export function withoutKey(text, section, key, reason) {
  const lines = text.split('\n');
  for (const entry of entriesOf(lines)) {
    if (isOf(entry, section) && entry.key === key) lines[entry.line] = `# ${lines[entry.line].trim()}  # ${reason}`;
  }
  return lines.join('\n');
}

/// The names of all sections of a kind, in their order: namesOf(text, 'valve') -> ['intake', 'exhaust'].
export function namesOf(text, kind) {
  const names = [];
  for (const line of text.split('\n')) {
    const header = /^\s*\[\s*([\w-]+)(?:\s+([\w-]+))?\s*\]\s*$/.exec(line.slice(0, commentAt(line)));
    if (header && header[1] === kind && !names.includes(header[2] ?? '')) names.push(header[2] ?? '');
  }
  return names;
}
