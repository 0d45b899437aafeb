// What a reader takes along: engine file, last cycle as CSV, wheels' signals as VCD, the scopes as a picture.

import {offer} from './dom.mjs';
import {toCsv} from './csv.mjs';
import {toVcd} from './vcd.mjs';

/// A name for a file: of the engine file's path, with another ending.
export function fileName(path, ending) {
  const stem = path.replace(/^.*[\\/]/, '').replace(/\.ini$/i, '').replace(/[^\w.-]/g, '_') || 'engine';
  return `${stem}${ending}`;
}

export function offerEngine(session) { offer(fileName(session.path, '.ini'), 'text/plain', session.text); }

/// False where there is no whole cycle yet.
export function offerCsv(session) {
  if (session.cycle === null) return false;
  const {columns, data} = session.cycle.rows;
  offer(fileName(session.path, '.csv'), 'text/csv', toCsv(columns, data));
  return true;
}

export async function offerVcd(session) {
  const wheels = session.engine?.facts.wheels ?? [];
  const {rows, end_s} = await session.ask({kind: 'edges'});
  if (rows.length === 0 || wheels.length === 0) return false;
  const changes = changesOf(rows, wheels.length);
  offer(fileName(session.path, '.vcd'), 'text/plain',
        toVcd(session.engine.facts.name, wheels.map(({name}) => name), changes, end_s));
  return true;
}

/// Edges as changes, each wheel's level before its first edge at their head. Faulty signals (wheels from 100) are left
/// out.
export function changesOf(rows, wheels) {
  const changes = [];
  const first_s = rows[0];
  for (let w = 0; w < wheels; ++w)
    for (let i = 0; i < rows.length; i += 3)
      if (rows[i + 1] === w) {
        changes.push({time_s: first_s, wire: w, level: 1 - rows[i + 2]});
        break;
      }
  for (let i = 0; i < rows.length; i += 3)
    if (rows[i + 1] < wheels) changes.push({time_s: rows[i], wire: rows[i + 1], level: rows[i + 2]});
  return changes;
}

/// All drawings that are shown, with their headings, on one sheet.
export function offerPicture(session, figures, palette) {
  const shown = figures.filter((figure) => !figure.hidden && figure.offsetParent !== null);
  const ratio = window.devicePixelRatio || 1;
  const box = shown.map((figure) => figure.getBoundingClientRect());
  const left = Math.min(...box.map((b) => b.left)) - 16;
  const top = Math.min(...box.map((b) => b.top)) - 56;
  const sheet = document.createElement('canvas');
  sheet.width = Math.ceil(ratio * (Math.max(...box.map((b) => b.right)) - left + 16));
  sheet.height = Math.ceil(ratio * (Math.max(...box.map((b) => b.bottom)) - top + 16));
  const context = sheet.getContext('2d');
  context.scale(ratio, ratio);
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, sheet.width, sheet.height);
  context.fillStyle = palette.ink;
  context.font = '600 20px system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", Arial, sans-serif';
  context.fillText(session.engine.facts.name, 16, 32);
  shown.forEach((figure) => drawFigure(context, figure, left, top));
  sheet.toBlob((blob) => offer(fileName(session.path, '.png'), 'image/png', blob), 'image/png');
}

function drawFigure(context, figure, left, top) {
  const heading = figure.querySelector('h3');
  if (heading !== null) {
    const at = heading.getBoundingClientRect();
    context.font = '600 14px system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", Arial, sans-serif';
    context.fillText(heading.textContent, at.left - left, at.bottom - top - 4);
  }
  for (const canvas of figure.querySelectorAll('canvas')) {
    const at = canvas.getBoundingClientRect();
    context.drawImage(canvas, at.left - left, at.top - top, at.width, at.height);
  }
}
