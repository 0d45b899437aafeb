// A canvas in CSS pixels, sharp on any display: its size follows its place on the page.

export class Surface {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.stale = true;
    new ResizeObserver(() => { this.stale = true; }).observe(canvas);
  }

  /// Cleared and ready: {context, width, height} in CSS pixels; null where there is no room.
  begin() {
    const {canvas, context} = this;
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (width < 20 || height < 20) return null;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = '11px system-ui, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", Arial, sans-serif';
    this.stale = false;
    return {context, width, height};
  }
}
