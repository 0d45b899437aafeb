// A scope's drawing: axes, ticks, curves. It knows no engine. A curve is {rows, n, x, y, colour, width, dash}: flat
// rows of n numbers; x(rows, at) and y(rows, at) give a row's place in units, at its index.

import {Surface} from './canvas.mjs';
import {angleTicks, extentOf, mapping, steadyRange, ticksOf} from './scale.mjs';

const kLeft = 46;
const kRight = 10;
const kTop = 18;
const kBottom = 20;

export class Plot {
  constructor(canvas) {
    this.surface = new Surface(canvas);
    this.range = null;
    this.rangeX = null;
  }

  /// x: {low, high, angle} or null: by the curves. bands: [{from, to, name}]. cursor: a place on x, or null.
  draw(palette, {curves, x = null, zero = true, least_span = 1e-9, below = 0, bands = [], cursor = null}) {
    const drawing = this.surface.begin();
    if (drawing === null) return;
    const {context, width, height} = drawing;
    this.range = steadyRange(extentOf(curves, 'y'), this.range, {zero, least_span, below});
    this.rangeX = x ?? steadyRange(extentOf(curves, 'x'), this.rangeX, {least_span});
    const toX = mapping(this.rangeX, {low: kLeft, high: width - kRight});
    const toY = mapping(this.range, {low: height - kBottom, high: kTop});
    Object.assign(this, {toX, curves});
    drawBands(context, palette, bands, toX, height);
    drawGrid(context, palette, this, x, toX, toY, width, height);
    context.save();
    context.beginPath();
    context.rect(kLeft - 1, kTop - 2, width - kLeft - kRight + 2, height - kTop - kBottom + 4);
    context.clip();
    for (const curve of curves) drawCurve(context, curve, toX, toY);
    if (cursor !== null) drawHair(context, palette, toX(cursor), height);
    context.restore();
  }

  /// At a pixel: {x, values: [{name, y}...]} of the curves that have a name, each at its nearest sample; null without.
  valuesAt(pixel) {
    const named = (this.curves ?? []).filter((curve) => curve.name && curve.rows.length > 0);
    if (named.length === 0 || pixel < kLeft) return null;
    const place = this.toX.back(pixel);
    const values = named.map((curve) => ({name: curve.name, y: curve.y(curve.rows, nearest(curve, place))}));
    return {x: named[0].x(named[0].rows, nearest(named[0], place)), values};
  }
}

/// Index of the sample whose x is nearest to a place.
function nearest({rows, n, x}, place) {
  let best = 0;
  for (let at = n; at < rows.length; at += n)
    if (Math.abs(x(rows, at) - place) < Math.abs(x(rows, best) - place)) best = at;
  return best;
}

function drawBands(context, palette, bands, toX, height) {
  context.textAlign = 'center';
  context.textBaseline = 'alphabetic';
  const fits = (text, {from, to}) => context.measureText(text).width < toX(to) - toX(from) - 4;
  const inFull = bands.every((band) => fits(band.name, band));  // or each by its short name
  bands.forEach((band, i) => {
    const [left, right] = [toX(band.from), toX(band.to)];
    context.fillStyle = palette.band;
    if (i % 2 === 0) context.fillRect(left, 2, right - left, height - kBottom - 2);
    context.fillStyle = palette.muted;
    const text = inFull ? band.name : band.short ?? band.name;
    if (fits(text, band)) context.fillText(text, (left + right) / 2, 13);
  });
}

function drawGrid(context, palette, plot, x, toX, toY, width, height) {
  const bottom = height - kBottom;
  context.lineWidth = 1;
  context.textBaseline = 'middle';
  context.textAlign = 'right';
  for (const tick of ticksOf(plot.range.low, plot.range.high, Math.max(2, Math.floor(height / 34)))) {
    line(context, tick === 0 ? palette.zero : palette.grid, kLeft, toY(tick), width - kRight, toY(tick));
    context.fillStyle = palette.muted;
    context.fillText(tickText(tick), kLeft - 6, toY(tick));
  }
  context.textBaseline = 'top';
  context.textAlign = 'center';
  const most = Math.floor((width - kLeft) / 42);
  const {low, high} = plot.rangeX;
  for (const tick of x?.angle ? angleTicks(low, high, most) : ticksOf(low, high, most)) {
    line(context, palette.grid, toX(tick), kTop, toX(tick), bottom);
    context.fillStyle = palette.muted;
    const half = context.measureText(tickText(tick)).width / 2;
    context.fillText(tickText(tick), Math.min(toX(tick), width - half), bottom + 5);
  }
  line(context, palette.axis, kLeft, bottom, width - kRight, bottom);
}

function tickText(tick) {
  const text = Math.abs(tick) >= 1e5 ? tick.toExponential().replace('e+', 'e') : String(tick);
  return text.replace('-', '−');
}

function line(context, colour, x0, y0, x1, y1) {
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(Math.round(x0) + 0.5, Math.round(y0) + 0.5);
  context.lineTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
  context.stroke();
}

/// Over the angle, where it falls far back, the curve begins anew: the cycle's end.
function drawCurve(context, {rows, n, x, y, colour, width = 2, dash = [], closed = false, wraps = false}, toX, toY) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.lineJoin = 'round';
  context.setLineDash(dash);
  context.beginPath();
  let last = Infinity;
  for (let at = 0; at < rows.length; at += n) {
    const place = toX(x(rows, at));
    if (last === Infinity || (wraps && last - place > 100)) context.moveTo(place, toY(y(rows, at)));
    else context.lineTo(place, toY(y(rows, at)));
    last = place;
  }
  if (closed && rows.length > 0) context.closePath();
  context.stroke();
  context.setLineDash([]);
}

function drawHair(context, palette, x, height) {
  context.lineWidth = 1;
  line(context, palette.axis, x, kTop, x, height - kBottom);
}

/// Rows of bars over x, each with a name at the left: contact states and the signals of wheels.
export class LanePlot {
  constructor(canvas) { this.surface = new Surface(canvas); }

  /// lanes: [{name, colour, bars: [[from, to]...], steps: [[x, level]...] or undefined}].
  draw(palette, {lanes, x, bands = [], cursor = null}) {
    const drawing = this.surface.begin();
    if (drawing === null) return;
    const {context, width, height} = drawing;
    const left = 92;
    const toX = mapping(x, {low: left, high: width - kRight});
    drawBands(context, palette, bands, toX, height);
    this.#axis(context, palette, x, toX, width, height, left);
    const room = (height - kTop - kBottom) / Math.max(1, lanes.length);
    lanes.forEach((lane, i) => drawLane(context, palette, lane, toX, left, kTop + i * room, Math.min(room, 34)));
    if (cursor !== null) drawHair(context, palette, toX(cursor), height);
  }

  #axis(context, palette, x, toX, width, height, left) {
    context.textBaseline = 'top';
    context.textAlign = 'center';
    for (const tick of angleTicks(x.low, x.high, Math.floor((width - left) / 42))) {
      line(context, palette.grid, toX(tick), kTop, toX(tick), height - kBottom);
      context.fillStyle = palette.muted;
      context.fillText(tickText(tick), Math.min(toX(tick), width - 12), height - kBottom + 5);
    }
    line(context, palette.axis, left, height - kBottom, width - kRight, height - kBottom);
  }
}

function drawLane(context, palette, lane, toX, left, top, room) {
  context.fillStyle = palette.ink;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  context.fillText(shortened(context, lane.name, left - 10), left - 8, top + room / 2);
  context.fillStyle = lane.colour;
  for (const [from, to] of lane.bars ?? [])
    context.fillRect(toX(from), top + 0.22 * room, Math.max(1, toX(to) - toX(from)), 0.56 * room);
  if (!lane.steps?.length) return;
  context.strokeStyle = lane.colour;
  context.lineWidth = 1.5;
  context.beginPath();
  const yOf = (level) => top + (level ? 0.2 : 0.8) * room;
  context.moveTo(toX(lane.steps[0][0]), yOf(lane.steps[0][1]));
  lane.steps.forEach(([at, level], i) => {
    if (i > 0) context.lineTo(toX(at), yOf(lane.steps[i - 1][1]));
    context.lineTo(toX(at), yOf(level));
  });
  context.stroke();
}

function shortened(context, text, room) {
  let short = text;
  while (short.length > 1 && context.measureText(short).width > room) short = short.slice(0, -2) + '…';
  return short;
}
