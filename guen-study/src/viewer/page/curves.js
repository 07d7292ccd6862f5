// What curves are drawn with: ticks and their texts, ranges, lines through samples, marks in a legend.

/** Round numbers inside a range, about `count` of them. */
function ticks(from, to, count) {
  const step = [1, 2, 2.5, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10((to - from) / count))).find((s) => (to - from) / s <= count);
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-9; k += 1) found.push(k * step);
  return found;
}

/** Texts for ticks, with the digits that tell them apart, and a power of ten that all of them are to be multiplied by. */
function labels(values) {
  const most = Math.max(...values.map(Math.abs));
  const power = most > 0 && (most >= 1e5 || most < 1e-2) ? Math.floor(Math.log10(most)) : 0;
  const step = values.length > 1 ? (values[1] - values[0]) / 10 ** power : 1;
  const digits = Math.min(Math.max(0, Math.ceil(-Math.log10(Math.abs(step)) - 1e-9)), 12);
  // A step such as 2.5 needs one more.
  const finer = values.some((v) => Math.abs(Number((v / 10 ** power).toFixed(digits)) - v / 10 ** power) > Math.abs(step) * 1e-3) ? 1 : 0;
  const texts = values.map((value) => (value / 10 ** power).toFixed(digits + finer).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−"));
  return { texts, power };
}

/** Numbers of a curve's samples that are drawn between two times: one before and one after with them. */
function samplesIn({ times }, from, to) {
  const last = locate(to, times).k + 1;
  return [locate(from, times).k, Math.min(last, times.length - 1)];
}

/** The least and the greatest value of curves between two times. */
function rangeOf(curves, from, to) {
  let [low, high] = [Infinity, -Infinity];
  for (const curve of curves) {
    const { times, values, base } = curve;
    if (times[times.length - 1] < from || times[0] > to) continue;
    const [begin, end] = [Math.max(from, times[0]), Math.min(to, times[times.length - 1])];
    const [first, last] = samplesIn(curve, from, to);
    const see = (value) => {
      low = Math.min(low, value);
      high = Math.max(high, value);
    };
    // At the edges a curve is between samples.
    see(valueAt(curve, begin));
    see(valueAt(curve, end));
    for (let k = first; k <= last; k += 1) if (times[k] >= from && times[k] <= to) see(base + values[k]);
  }
  return [low, high];
}

/**
 * Draws a curve through those of its points that make the same picture: of each column of pixels the first, the least, the
 * greatest and the last.
 */
function trace({ times, values, base }, [first, last], column, draw) {
  const point = (k) => draw(times[k], base + values[k]);
  let k = first;
  while (k <= last) {
    const here = column(times[k]);
    let [low, high, to] = [k, k, k];
    while (to <= last && column(times[to]) === here) {
      if (values[to] < values[low]) low = to;
      if (values[to] > values[high]) high = to;
      to += 1;
    }
    const four = new Set([k, Math.min(low, high), Math.max(low, high), to - 1]);
    four.forEach(point);
    k = to;
  }
}

/** A part of the largest value of a panel below which a number is rounding, and reads as nothing. */
const NOISE = 1e-12;
const reading = (value, size) => short(Math.abs(value) < NOISE * size ? 0 : value);

/** The mark of a curve in a legend: its colour, with the gaps of its dashes. */
function markOf(curve) {
  const [ink, dash] = [inkOf(curve.slot), dashOf(curve)];
  if (dash.length === 0) return ink;
  let at = 0;
  const stops = dash.map((length, i) => `${i % 2 ? "transparent" : ink} ${at}px ${(at += length)}px`);
  return `repeating-linear-gradient(90deg, ${stops.join(", ")})`;
}
