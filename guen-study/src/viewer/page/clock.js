// Times as texts, with their unit and the digits that tell samples apart, and the pace of the motion.

/** Parts of a second that have a name. */
const PREFIXES = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

/** A length of time as a factor and a name: seconds in the thousands and units of other names stay as they are. */
function unitFor(time) {
  const prefix = motion.timeUnit === "s" && time > 0 && time < 0.1 ? PREFIXES.find(([factor]) => factor <= time * (1 + 1e-9)) ?? PREFIXES.at(-1) : PREFIXES[0];
  return { factor: prefix[0], name: prefix[1] + motion.timeUnit };
}

/** Digits after the point that tell numbers apart which differ by a step, of numbers up to a size. */
function digitsFor(step, size) {
  const all = 15 - Math.max(0, Math.ceil(Math.log10(size)));
  return step > 0 ? Math.max(0, Math.min(all, Math.ceil(-Math.log10(step) - 1e-9))) : 0;
}

const minus = (text) => text.replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−");

const clock = (() => {
  const { times, start, end } = motion;
  const most = Math.max(Math.abs(start), Math.abs(start + end));
  const unit = unitFor(most);
  let step = end;
  for (let k = 1; k < times.length; k += 1) step = Math.min(step, times[k] - times[k - 1]);
  // An adaptive method may take a step that nobody sees.
  const digits = digitsFor(Math.max(step, end * 1e-9) / unit.factor, most / unit.factor);
  /** A time since the start, as it is on the clock of the motion. */
  const text = (time) => minus(motion.still ? String(Number((start / unit.factor).toPrecision(6))) : ((start + time) / unit.factor).toFixed(digits));
  /** Texts for rising times since the start, with the digits that tell them apart. */
  function texts(moments) {
    const between = moments.length > 1 ? (moments[1] - moments[0]) / unit.factor : 1;
    const short = digitsFor(between, most / unit.factor);
    // A step such as 2.5 needs one more.
    const finer = Math.abs(Number(between.toFixed(short)) - between) > between * 1e-3 ? 1 : 0;
    if (motion.still) return moments.map(text);
    return moments.map((time) => minus(((start + time) / unit.factor).toFixed(short + finer)));
  }
  /** A length of time in its own unit. */
  function length(time) {
    const { factor, name } = unitFor(time);
    return `${short(time / factor)} ${name}`;
  }
  return { text, texts, length, unit: unit.name };
})();

/** A motion that is over before one sees it, or takes too long to be watched, is shown in about so many seconds. */
const PLEASANT = 20;

/** The pace at which the page begins: the motion's own, or 1, 2 or 5 times a power of ten. */
const pace = (() => {
  if (motion.still || (motion.end >= 1 && motion.end <= 600)) return 1;
  const wanted = motion.end / PLEASANT;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return Number(([5, 2, 1].find((digit) => digit * power <= wanted * 1.0001) * power).toPrecision(1));
})();

/** A pace in words: how many times the motion's own, or what passes in a second where that is little. */
function paceText(value) {
  if (motion.timeUnit !== "s" || value >= 0.01) return `${Number(value.toPrecision(2))} ×`;
  const { factor, name } = unitFor(value);
  return `${Number((value / factor).toPrecision(2))} ${name} a second`;
}

/** Fills a list with paces about that of the beginning. */
function offerPaces(list) {
  list.replaceChildren(
    ...[0.1, 0.25, 0.5, 1, 2, 5, 20].map((part) => {
      const value = Number((part * pace).toPrecision(2));
      const option = new Option(paceText(value), String(value));
      option.selected = part === 1;
      option.defaultSelected = part === 1;
      return option;
    }),
  );
}
