// Bars and steps over a cycle's angle, from samples and edges: for contact states and trigger wheels.

/// Bars [from, to] in which holds(row) is true; angle(row) in the order of the rows but for one fall back at its end.
export function barsOf(count, angle, holds) {
  const bars = [];
  let open = null;
  let last = 0;
  for (let i = 0; i < count; ++i) {
    const deg = angle(i);
    if (open !== null && (deg < last || !holds(i))) {
      bars.push([open, deg < last ? Math.max(last, 720) : deg]);
      open = null;
    }
    if (open === null && holds(i)) open = deg < last && i > 0 ? 0 : deg;
    last = deg;
  }
  if (open !== null) bars.push([open, Math.max(last, open)]);
  return bars;
}

/// Steps [[deg, level]...] over 0 to 720 of one wheel, from flat rows of deg, wheel, level; angle shifts by the
/// cylinder's own dead centre. None where the wheel had no edge in the cycle.
export function stepsOf(edges, wheel, firing_deg) {
  const steps = [];
  for (let i = 0; i < edges.length; i += 3)
    if (edges[i + 1] === wheel) steps.push([((edges[i] - firing_deg) % 720 + 720) % 720, edges[i + 2]]);
  if (steps.length === 0) return steps;
  steps.sort((a, b) => a[0] - b[0]);
  const last = steps[steps.length - 1][1];
  return [[0, last], ...steps, [720, last]];
}
