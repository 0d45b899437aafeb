// The page's colours for canvases, read from its style sheet: light, dark, and light on paper.

const kNames = ['paper', 'ink', 'muted', 'rule', 'grid', 'axis', 'zero', 'band', 'accent', 'before', 'metal', 'metal-2',
                'series-1', 'series-2', 'series-3', 'series-4', 'series-5', 'series-6', 'hot', 'cold'];

export class Palette {
  constructor(changed) {
    this.read();
    const reread = () => {
      this.read();
      changed();
    };
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', reread);
    matchMedia('print').addEventListener('change', reread);
  }

  read() {
    const style = getComputedStyle(document.documentElement);
    for (const name of kNames) this[name] = style.getPropertyValue(`--${name}`).trim();
  }

  series(number) { return this[`series-${1 + number % 6}`]; }
}
