// The span of time that all panels show: the whole motion, or a part of it that was asked for.

/** Parts of the motion below which nothing is there to be seen. */
const SHORTEST_SPAN = 1e-9;

function makeSpan(redraw) {
  const bar = document.getElementById("part");
  const text = bar.querySelector("span");
  const span = { from: 0, to: motion.end, isWhole: true };

  function set(from, to) {
    const length = Math.min(Math.max(to - from, SHORTEST_SPAN * motion.end), motion.end);
    // Beyond an end it is moved, not cut.
    span.from = Math.min(Math.max((from + to - length) / 2, 0), motion.end - length);
    span.to = span.from + length;
    span.isWhole = length === motion.end;
    if (span.isWhole) [span.from, span.to] = [0, motion.end];
    bar.hidden = span.isWhole;
    const [first, last] = clock.texts([span.from, span.to]);
    text.textContent = `${first} to ${last} ${clock.unit}`;
    redraw();
  }
  const reset = () => set(0, motion.end);
  /** Shows a part or a multiple of the time, with one moment where it was. */
  function zoom(factor, about) {
    const at = Math.min(Math.max(about, span.from), span.to);
    set(at - (at - span.from) * factor, at + (span.to - at) * factor);
  }
  /** Moves by parts of what is shown. */
  const pan = (parts) => {
    const by = parts * (span.to - span.from);
    const within = Math.min(Math.max(by, -span.from), motion.end - span.to);
    set(span.from + within, span.to + within);
  };
  /** Turns over to the next page when time runs out of the span. */
  function follow(before, now) {
    const inside = (time) => time >= span.from && time <= span.to;
    if (!span.isWhole && inside(before) && !inside(now)) pan(Math.floor((now - span.from) / (span.to - span.from)));
  }
  bar.querySelector("button").addEventListener("click", reset);
  return Object.assign(span, { set, reset, zoom, pan, follow });
}
