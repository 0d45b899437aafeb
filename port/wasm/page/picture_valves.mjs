// Valves, springs, rockers and cams of the cylinder's picture. pen: picture.mjs's, in metres.

/// state: {lift_m, wanted_m, regime} of a train, already enlarged; regime NaN where nothing is known of contacts.
export function drawTrain(pen, layout, part, state, enlarged) {
  drawPort(pen, layout, part);
  drawValve(pen, layout, part, state);
  drawSpring(pen, layout, part, state.lift_m);
  if (part.kind === 'direct') drawBucket(pen, layout, part, state);
  else drawRocker(pen, layout, part, state);
  drawCam(pen, part, enlarged);
  drawContacts(pen, layout, part, state);
}

function drawPort(pen, {face_m, bore_m, wall_m, deck_m}, {x_m, head_m, outward}) {
  const end_m = outward * (bore_m / 2 + wall_m);
  const inner_m = 0.42 * head_m;
  const y0 = face_m;
  const y1 = face_m + 0.72 * (deck_m - face_m);
  const y2 = y1 - 0.8 * head_m * 0.62;
  pen.path(pen.palette.paper, null, (to) => {
    to.move(x_m - outward * inner_m, y0);
    to.curve(x_m - outward * inner_m, y1, x_m + outward * 0.2 * head_m, y1, end_m, y1);
    to.line(end_m, y2);
    to.curve(x_m + outward * inner_m, y2, x_m + outward * inner_m, y2, x_m + outward * inner_m, y0);
  });
}

function drawValve(pen, {face_m, bore_m}, {x_m, head_m, tip_m}, {lift_m}) {
  const stem_m = 0.035 * bore_m;
  const y = face_m - lift_m;
  pen.path(pen.palette.metal, pen.palette.ink, (to) => {
    to.move(x_m - head_m / 2, y - 0.02 * bore_m);
    to.line(x_m - head_m / 2, y);
    to.curve(x_m - 0.2 * head_m, y + 0.06 * bore_m, x_m - stem_m, y + 0.08 * bore_m, x_m - stem_m, y + 0.2 * bore_m);
    to.line(x_m - stem_m, tip_m - lift_m);
    to.line(x_m + stem_m, tip_m - lift_m);
    to.line(x_m + stem_m, y + 0.2 * bore_m);
    to.curve(x_m + stem_m, y + 0.08 * bore_m, x_m + 0.2 * head_m, y + 0.06 * bore_m, x_m + head_m / 2, y);
    to.line(x_m + head_m / 2, y - 0.02 * bore_m);
    to.close();
  });
}

function drawSpring(pen, {deck_m, bore_m}, {x_m, tip_m}, lift_m) {
  const top_m = tip_m - 0.07 * bore_m - lift_m;
  const half_m = 0.115 * bore_m;
  const coils = 6;
  pen.path(null, pen.palette.muted, (to) => {
    to.move(x_m - half_m, deck_m);
    for (let i = 1; i <= 2 * coils; ++i)
      to.line(x_m + (i % 2 ? half_m : -half_m), deck_m + (top_m - deck_m) * i / (2 * coils));
  }, 1.5);
  pen.box(pen.palette['metal-2'], pen.palette.ink, x_m - 1.15 * half_m, top_m, 2.3 * half_m, 0.035 * bore_m);
}

function drawBucket(pen, {bore_m}, {x_m, tip_m, bucket_m}, {wanted_m}) {
  const half_m = 0.16 * bore_m;
  const top_m = tip_m + bucket_m - wanted_m;
  pen.box(pen.palette['metal-2'], pen.palette.ink, x_m - half_m, top_m - bucket_m, 2 * half_m, bucket_m);
}

function drawRocker(pen, {bore_m}, {x_m, tip_m, pivot, pad, cam_per_valve}, {wanted_m}) {
  const thick_m = 0.075 * bore_m;
  const tip = {x_m, y_m: tip_m + thick_m / 2 - wanted_m};
  const heel = {x_m: pad.x_m, y_m: pad.y_m + thick_m / 2 + cam_per_valve * wanted_m};
  pen.bar(pen.palette['metal-2'], thick_m, [tip, {x_m: pivot.x_m, y_m: pivot.y_m + 0.25 * thick_m}, heel]);
  pen.disc(pen.palette.paper, pen.palette.ink, pivot.x_m, pivot.y_m, 0.4 * thick_m);
}

function drawCam(pen, {cam, outline, base_m}, enlarged) {
  pen.turned(cam, () => outline(enlarged));
  pen.disc(pen.palette.ink, null, cam.x_m, cam.y_m, 0.12 * base_m);
}

/// A dot where two parts touch: on the stem's tip and at the seat.
function drawContacts(pen, {face_m}, {x_m, tip_m, head_m, outward}, {lift_m, regime}) {
  if (!Number.isFinite(regime)) return;
  const train = (regime & 1) !== 0;
  const seat = (regime & 2) !== 0;
  pen.mark(train, x_m, tip_m - lift_m);
  pen.mark(seat, x_m + outward * head_m / 2, face_m - lift_m);
}
