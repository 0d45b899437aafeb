// All cylinders beside each other: pistons at their place, gas by its pressure, the order in which they fire.

import {Surface} from './canvas.mjs';
import {deadCentresOf, displacementOf, strokeName, wrapped} from './mechanism.mjs';

export class FiringPicture {
  /// chosen(cylinder) is called when one is pointed at, counted from 1.
  constructor(canvas, chosen) {
    this.surface = new Surface(canvas);
    this.facts = null;
    canvas.addEventListener('click', ({offsetX}) => {
      if (this.facts === null) return;
      const n = this.facts.cylinders.length;
      chosen(Math.min(n, 1 + Math.floor(offsetX / canvas.clientWidth * n)));
    });
  }

  setEngine(facts) {
    this.facts = facts;
    const {top_m, bottom_m} = deadCentresOf(facts.crank);
    this.stroke_m = top_m - bottom_m;
  }

  /// gas: 0 to 1 of each cylinder; cylinder: the one that is shown, from 1.
  draw(palette, crank_deg, gas, cylinder) {
    const drawing = this.facts === null ? null : this.surface.begin();
    if (drawing === null) return;
    const wide = drawing.width / this.facts.cylinders.length;
    this.facts.cylinders.forEach(({firing_deg}, i) => {
      const own_deg = wrapped(crank_deg - firing_deg, 720);
      const share = displacementOf(this.facts.crank, own_deg * Math.PI / 180) / this.stroke_m;
      drawOne(drawing, palette, {left: i * wide, wide, own_deg, share, gas: gas[i], number: i + 1,
                                 chosen: i + 1 === cylinder});
    });
  }
}

function drawOne({context, height}, palette, {left, wide, own_deg, share, gas, number, chosen}) {
  const bore = Math.min(44, 0.62 * wide);
  const box = {x: left + (wide - bore) / 2, top: 20, bore, floor: height - 20, piston: 14};
  const crown = box.top + 4 + share * (box.floor - box.top - box.piston - 6);
  drawGas(context, palette, box, crown, gas);
  context.fillStyle = palette.metal;
  context.fillRect(box.x, crown, bore, box.piston);
  context.strokeStyle = chosen ? palette.accent : palette.axis;
  context.lineWidth = chosen ? 2.5 : 1;
  context.strokeRect(box.x, box.top, bore, box.floor - box.top);
  context.strokeRect(box.x, crown, bore, box.piston);
  context.textAlign = 'center';
  context.textBaseline = 'alphabetic';
  context.fillStyle = chosen ? palette.accent : palette.ink;
  context.fillText(String(number), left + wide / 2, 13);
  context.fillStyle = palette.muted;
  const name = strokeName(own_deg);
  const hasRoom = context.measureText('compression').width < wide;  // the longest: all are names, or all are letters
  context.fillText(hasRoom ? name : name[0], left + wide / 2, height - 6);
}

function drawGas(context, palette, {x, top, bore}, crown, gas) {
  for (const [colour, alpha] of [[palette.cold, 0.25], [palette.hot, 0.85 * Math.min(1, Math.max(0, gas || 0))]]) {
    context.fillStyle = colour;
    context.globalAlpha = alpha;
    context.fillRect(x, top, bore, crown - top);
  }
  context.globalAlpha = 1;
}
