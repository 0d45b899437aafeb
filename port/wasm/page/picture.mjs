// The picture of one cylinder: crank, rod, piston, gas, head and valve trains, at an angle between two ticks.

import {Surface} from './canvas.mjs';
import {poseOf} from './mechanism.mjs';
import {camTurn_rad, layoutOf} from './picture_layout.mjs';
import {drawTrain} from './picture_valves.mjs';

export class Picture {
  constructor(canvas) {
    this.surface = new Surface(canvas);
    this.layout = null;
  }

  setEngine(facts) { this.layout = layoutOf(facts); }

  /// state: {cylinder_deg, gas (0 to 1: pressure by its largest), trains: [{lift_m, wanted_m, regime}...], enlarged}
  draw(palette, state) {
    const drawing = this.layout === null ? null : this.surface.begin();
    if (drawing === null) return;
    const pen = new Pen(drawing, palette, this.layout);
    const pose = poseOf(this.layout.crank, state.cylinder_deg * Math.PI / 180);
    drawGas(pen, this.layout, pose, state.gas);
    drawBlock(pen, this.layout);
    this.layout.trains.forEach((part, i) => {
      const {lift_m, wanted_m, regime} = state.trains[i] ?? {lift_m: 0, wanted_m: 0, regime: NaN};
      const k = state.enlarged;
      pen.camTurn_rad = camTurn_rad(part.train, state.cylinder_deg);
      drawTrain(pen, this.layout, part, {lift_m: k * lift_m, wanted_m: k * wanted_m, regime}, k);
    });
    drawCrank(pen, this.layout, pose);
    drawRod(pen, this.layout, pose);
    drawPiston(pen, this.layout, pose);
    drawJournals(pen, this.layout, pose);
  }
}

function drawGas(pen, {bore_m, crown_m, face_m}, {piston}, gas) {
  const crown = piston.y_m + crown_m;
  pen.context.globalAlpha = 0.25;
  pen.box(pen.palette.cold, null, piston.x_m - bore_m / 2, crown, bore_m, face_m - crown);
  pen.context.globalAlpha = 0.85 * Math.min(1, Math.max(0, gas));
  pen.box(pen.palette.hot, null, piston.x_m - bore_m / 2, crown, bore_m, face_m - crown);
  pen.context.globalAlpha = 1;
}

function drawBlock(pen, {crank, bore_m, face_m, deck_m, liner_m, wall_m}) {
  const e = crank.pin_offset_m;
  for (const x of [e - bore_m / 2 - wall_m, e + bore_m / 2])
    pen.box(pen.palette['metal-2'], pen.palette.axis, x, liner_m, wall_m, face_m - liner_m);
  pen.box(pen.palette.metal, pen.palette.axis, e - bore_m / 2 - wall_m, face_m, bore_m + 2 * wall_m, deck_m - face_m);
}

function drawCrank(pen, {crank, bore_m}, {pin}) {
  const r = crank.crank_radius_m;
  const heavy_m = r + 0.16 * bore_m;
  const toward_rad = Math.atan2(pin.y_m, pin.x_m);
  pen.sector(pen.palette['metal-2'], heavy_m, toward_rad + Math.PI - 1.0, toward_rad + Math.PI + 1.0);
  pen.bar(pen.palette['metal-2'], 0.3 * bore_m, [{x_m: 0, y_m: 0}, pin]);
}

function drawRod(pen, {bore_m}, {pin, piston}) {
  const length_m = Math.hypot(piston.x_m - pin.x_m, piston.y_m - pin.y_m);
  const ux = (piston.x_m - pin.x_m) / length_m;
  const uy = (piston.y_m - pin.y_m) / length_m;
  const big_m = 0.1 * bore_m;
  const small_m = 0.065 * bore_m;
  pen.path(pen.palette.metal, pen.palette.ink, (to) => {
    to.move(pin.x_m - uy * big_m, pin.y_m + ux * big_m);
    to.line(piston.x_m - uy * small_m, piston.y_m + ux * small_m);
    to.line(piston.x_m + uy * small_m, piston.y_m - ux * small_m);
    to.line(pin.x_m + uy * big_m, pin.y_m - ux * big_m);
    to.close();
  });
  pen.disc(pen.palette.metal, pen.palette.ink, pin.x_m, pin.y_m, 0.18 * bore_m);
}

function drawPiston(pen, {bore_m, crown_m, skirt_m}, {piston}) {
  const left = piston.x_m - bore_m / 2;
  const crown = piston.y_m + crown_m;
  const slot = 0.01 * bore_m;
  pen.box(pen.palette.metal, pen.palette.ink, left + slot, piston.y_m - skirt_m, bore_m - 2 * slot, crown_m + skirt_m);
  for (const down of [0.1, 0.18, 0.27])
    pen.path(null, pen.palette.axis, (to) => {
      to.move(left, crown - down * bore_m);
      to.line(left + bore_m, crown - down * bore_m);
    });
  pen.disc(pen.palette.paper, pen.palette.ink, piston.x_m, piston.y_m, 0.11 * bore_m);
}

function drawJournals(pen, {bore_m}, {pin}) {
  pen.disc(pen.palette.paper, pen.palette.ink, pin.x_m, pin.y_m, 0.11 * bore_m);
  pen.disc(pen.palette.paper, pen.palette.ink, 0, 0, 0.13 * bore_m);
}

/// Draws in metres.
class Pen {
  constructor({context, width, height}, palette, layout) {
    Object.assign(this, {context, palette, camTurn_rad: 0});
    const tall_m = layout.roof_m - layout.floor_m;
    this.scale = Math.min((height - 12) / tall_m, (width - 12) / (2 * layout.side_m));
    this.left = width / 2;
    this.base = height / 2 + this.scale * (layout.roof_m + layout.floor_m) / 2;
    context.lineWidth = 1;
    context.lineJoin = 'round';
  }

  x(x_m) { return this.left + this.scale * x_m; }
  y(y_m) { return this.base - this.scale * y_m; }

  path(fill, stroke, build, width = 1) {
    const {context} = this;
    context.beginPath();
    build({
      move: (x, y) => context.moveTo(this.x(x), this.y(y)),
      line: (x, y) => context.lineTo(this.x(x), this.y(y)),
      curve: (a, b, c, d, x, y) => context.bezierCurveTo(this.x(a), this.y(b), this.x(c), this.y(d), this.x(x),
                                                         this.y(y)),
      close: () => context.closePath(),
    });
    this.#finish(fill, stroke, width);
  }

  box(fill, stroke, x, y, wide, tall) {
    this.context.beginPath();
    this.context.rect(this.x(x), this.y(y + tall), this.scale * wide, this.scale * tall);
    this.#finish(fill, stroke, 1);
  }

  disc(fill, stroke, x, y, radius) {
    this.context.beginPath();
    this.context.arc(this.x(x), this.y(y), this.scale * radius, 0, 2 * Math.PI);
    this.#finish(fill, stroke, 1);
  }

  sector(fill, radius, from_rad, to_rad) {
    const {context} = this;
    context.beginPath();
    context.moveTo(this.x(0), this.y(0));
    context.arc(this.x(0), this.y(0), this.scale * radius, -to_rad, -from_rad);
    context.closePath();
    this.#finish(fill, this.palette.ink, 1);
  }

  /// A thick line with round ends, outlined.
  bar(colour, thick_m, places) {
    const {context} = this;
    context.lineCap = 'round';
    for (const [stroke, width] of [[this.palette.ink, this.scale * thick_m + 1.5], [colour, this.scale * thick_m]]) {
      context.beginPath();
      places.forEach(({x_m, y_m}, i) => i === 0 ? context.moveTo(this.x(x_m), this.y(y_m))
                                                : context.lineTo(this.x(x_m), this.y(y_m)));
      context.strokeStyle = stroke;
      context.lineWidth = Math.max(1, width);
      context.stroke();
    }
    context.lineCap = 'butt';
    context.lineWidth = 1;
  }

  /// A cam's outline about its centre, turned against the follower that it touches.
  turned({x_m, y_m, contact_rad}, outline) {
    const points = outline();
    const c = Math.cos(contact_rad - this.camTurn_rad);
    const s = Math.sin(contact_rad - this.camTurn_rad);
    this.path(this.palette.metal, this.palette.ink, (to) => {
      for (let i = 0; i < points.length; i += 2) {
        const x = x_m + c * points[i] - s * points[i + 1];
        const y = y_m + s * points[i] + c * points[i + 1];
        if (i === 0) to.move(x, y);
        else to.line(x, y);
      }
      to.close();
    });
  }

  mark(on, x_m, y_m) {
    this.context.beginPath();
    this.context.arc(this.x(x_m), this.y(y_m), 3.5, 0, 2 * Math.PI);
    this.#finish(on ? this.palette['series-3'] : this.palette.paper, on ? this.palette['series-3']
                                                                         : this.palette['series-2'], 1.5);
  }

  #finish(fill, stroke, width) {
    const {context} = this;
    if (fill) {
      context.fillStyle = fill;
      context.fill();
    }
    if (!stroke) return;
    context.strokeStyle = stroke;
    context.lineWidth = width;
    context.stroke();
    context.lineWidth = 1;
  }
}
