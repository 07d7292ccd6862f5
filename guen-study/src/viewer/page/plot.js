// What the pointer does on a plot: reads values, sets the time, marks a part of it, comes nearer.

/** Pixels that a hand trembles. */
const TREMBLE = 4;

function listenToPlot(canvas, axis, { span, probe, redraw, onPick }) {
  const { timeAt } = axis;
  const fingers = new Map();
  let [pressed, pinched] = [null, null];
  const clamped = (time) => Math.min(Math.max(time, span.from), span.to);
  const isTouch = (event) => event.pointerType === "touch";
  function read(time) {
    [probe.time, probe.canvas] = [time, time === null ? null : canvas];
    redraw();
  }
  /** Two fingers keep the times that they took hold of. */
  function pinch() {
    const [a, b] = [...fingers.values()];
    if (Math.abs(b - a) < 2 * TREMBLE) return;
    const perPixel = (pinched[1] - pinched[0]) / (b - a);
    if (!(perPixel > 0)) return;
    const from = pinched[0] - perPixel * (a - axis.left());
    span.set(from, from + perPixel * axis.width());
  }

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    if (isTouch(event)) fingers.set(event.pointerId, event.clientX);
    pinched = fingers.size === 2 ? [...fingers.values()].map(timeAt) : null;
    pressed = fingers.size > 1 ? null : { at: event.clientX, time: clamped(timeAt(event.clientX)) };
  });
  canvas.addEventListener("pointermove", (event) => {
    const time = clamped(timeAt(event.clientX));
    if (isTouch(event)) {
      if (!fingers.has(event.pointerId)) return;
      fingers.set(event.pointerId, event.clientX);
      if (pinched) pinch();
      else if (pressed) onPick(time);
      return;
    }
    if (pressed && Math.abs(event.clientX - pressed.at) > TREMBLE) probe.marked = [pressed.time, time];
    read(time);
  });
  canvas.addEventListener("pointerup", (event) => {
    const touched = isTouch(event);
    fingers.delete(event.pointerId);
    pinched = null;
    const { marked } = probe;
    probe.marked = null;
    if (marked && marked[0] !== marked[1]) span.set(Math.min(...marked), Math.max(...marked));
    else if (pressed) onPick(clamped(timeAt(event.clientX)));
    pressed = null;
    read(touched ? null : clamped(timeAt(event.clientX)));
  });
  const leave = (event) => {
    fingers.delete(event.pointerId);
    [pressed, pinched, probe.marked] = [null, null, null];
    read(null);
  };
  canvas.addEventListener("pointercancel", leave);
  canvas.addEventListener("pointerleave", (event) => {
    if (!pressed) leave(event);
  });
  canvas.addEventListener("dblclick", span.reset);
  canvas.addEventListener(
    "wheel",
    (event) => {
      const limited = (delta) => Math.min(Math.max(delta, -60), 60);
      if (event.ctrlKey || event.metaKey) span.zoom(Math.exp(limited(event.deltaY) * 0.005), timeAt(event.clientX));
      else if (!span.isWhole && Math.abs(event.deltaX) > Math.abs(event.deltaY)) span.pan(limited(event.deltaX) / 400);
      else return;
      event.preventDefault();
    },
    { passive: false },
  );
}
