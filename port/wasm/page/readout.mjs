// Values under the pointer over a scope: the curves' names and what they have at the nearest sample.

import {element, setText} from './dom.mjs';
import {readable} from './numbers.mjs';

export class ReadOut {
  constructor() {
    this.box = element('div', {class: 'read-out', hidden: true, 'aria-hidden': 'true'});
    document.body.append(this.box);
  }

  /// plot: one of plot.mjs; unitX: "deg".
  watch(canvas, plot, unitX) {
    canvas.addEventListener('pointermove', (event) => this.#show(plot, unitX, event));
    canvas.addEventListener('pointerleave', () => { this.box.hidden = true; });
  }

  #show(plot, unitX, {offsetX, pageX, pageY}) {
    const lines = plot.valuesAt(offsetX);
    this.box.hidden = lines === null;
    if (lines === null) return;
    const {x, values} = lines;
    setText(this.box, [`${readable(x)} ${unitX}`, ...values.map(({name, y}) => `${name} ${readable(y)}`)].join('\n'));
    this.box.style.left = `${Math.min(pageX + 14, document.documentElement.clientWidth - this.box.offsetWidth - 4)}px`;
    this.box.style.top = `${pageY + 14}px`;
  }
}
