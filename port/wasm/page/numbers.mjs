// Numbers as people read them: four digits, one unit of the field's, no exponent where none is needed.

/// Four significant digits, at least all before the point; the minus is the sign, not a hyphen.
export function readable(value, digits = 4) {
  if (!Number.isFinite(value)) return '–';
  if (Number.isInteger(value) && Math.abs(value) < 1e6) return String(value).replace('-', '−');
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size > 7) return value.toExponential(digits - 1).replace('-', '−');
  const text = value.toFixed(Math.min(20, Math.max(0, digits - 1 - size)));
  return text.replace('-', '−');
}

/// How a quantity in SI is shown, as in the program's reports: by the suffix of its name.
const kShown = [
  ['_rad_s', 30 / Math.PI, 'rpm'], ['_m_s2', 1, 'm/s²'], ['_m_s', 1, 'm/s'], ['_kg_s', 1e3, 'g/s'], ['_kg', 1e6, 'mg'],
  ['_Pa', 1e-3, 'kPa'], ['_Nm', 1, 'Nm'], ['_N', 1, 'N'], ['_W', 1e-3, 'kW'], ['_K', 1, 'K'], ['_J', 1, 'J'],
  ['_deg', 1, 'deg'], ['_m', 1e3, 'mm'], ['_s', 1, 's'],
];

/// {factor, unit} for a variable's name like "valve[1,1].lift_m".
export function shownAs(name) {
  const plain = name.replace(/\[[^\]]*\]/g, '');
  const found = kShown.find(([suffix]) => plain.endsWith(suffix));
  return found ? {factor: found[1], unit: found[2]} : {factor: 1, unit: ''};
}

/// A value that a slider writes into an engine file: no more digits than its step has.
export function ofStep(value, step) {
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  return String(Number(value.toFixed(Math.min(digits + 1, 12))));
}
