// Panels of curves over time, with a cursor where the motion is.

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
  const digits = Math.min(Math.max(0, Math.ceil(-Math.log10(Math.abs(step)) - 1e-9)), 8);
  // A step such as 2.5 needs one more.
  const finer = values.some((v) => Math.abs(Number((v / 10 ** power).toFixed(digits)) - v / 10 ** power) > Math.abs(step) * 1e-3) ? 1 : 0;
  const texts = values.map((value) => (value / 10 ** power).toFixed(digits + finer).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−"));
  return { texts, power };
}

/**
 * Draws a curve through those of its points that make the same picture: of each column of pixels the first, the least, the
 * greatest and the last.
 */
function trace({ times, values, base }, column, draw) {
  const point = (k) => draw(times[k], base + values[k]);
  let k = 0;
  while (k < values.length) {
    const here = column(times[k]);
    let [low, high, to] = [k, k, k];
    while (to < values.length && column(times[to]) === here) {
      if (values[to] < values[low]) low = to;
      if (values[to] > values[high]) high = to;
      to += 1;
    }
    const four = new Set([k, Math.min(low, high), Math.max(low, high), to - 1]);
    four.forEach(point);
    k = to;
  }
}

/** The mark of a curve in a legend: its colour, with the gaps of its dashes. */
function markOf(slot) {
  const [ink, dash] = [inkOf(slot), dashOf(slot)];
  if (dash.length === 0) return ink;
  let at = 0;
  const stops = dash.map((length, i) => `${i % 2 ? "transparent" : ink} ${at}px ${(at += length)}px`);
  return `repeating-linear-gradient(90deg, ${stops.join(", ")})`;
}

// Width, height and pixels to a unit of a panel that is printed.
const PAPER_SIZE = [680, 150, 3];

function makePanel(panel, parent, onPick) {
  const figure = document.createElement("figure");
  const caption = document.createElement("figcaption");
  const heading = document.createElement("b");
  heading.textContent = panel.name;
  caption.append(heading);
  const readings = panel.curves.map((curve, i) => {
    const reading = document.createElement("span");
    const mark = document.createElement("i");
    painted(() => mark.style.setProperty("background", markOf(i)));
    const text = document.createTextNode(curve.name);
    reading.append(mark, text);
    caption.append(reading);
    return text;
  });
  const factor = document.createElement("small");
  caption.append(factor);
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  figure.append(caption, canvas);
  parent.append(figure);

  let [low, high] = [Infinity, -Infinity];
  for (const { values, base } of panel.curves) {
    for (const value of values) {
      low = Math.min(low, base + value);
      high = Math.max(high, base + value);
    }
  }
  canvas.setAttribute("aria-label", `${panel.name} over time: ${panel.curves.map((curve) => curve.name).join(", ")}; from ${short(low)} to ${short(high)}`);
  // What is constant to single precision is drawn so; what has a base has more digits.
  const size = Math.max(Math.abs(low), Math.abs(high));
  const least = size > 0 ? size * (panel.curves.some(({ base }) => base !== 0) ? 1e-13 : 1e-5) : 1;
  if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
  const room = (high - low) * 0.06;
  [low, high] = [low - room, high + room];

  const [right, top, bottom] = [8, 6, 20];
  let left = 48;
  const layer = document.createElement("canvas");
  let [width, height, ratio] = [0, 0, 1];
  const x = (t) => left + (width - left - right) * (motion.still ? 0.5 : t / motion.end);
  const y = (v) => top + ((height - top - bottom) * (high - v)) / (high - low);

  /** Axes and curves, once for each size and theme. */
  function paintLayer() {
    const [ink, line] = ["--faint", "--line"].map(pageInk);
    [layer.width, layer.height] = [width * ratio, height * ratio];
    const pen = layer.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = ink;
    pen.strokeStyle = line;
    pen.lineWidth = 1;
    const heights = ticks(low, high, 4);
    const { texts, power } = labels(heights);
    left = Math.max(40, ...texts.map((text) => pen.measureText(text).width + 12));
    canvas.dataset.left = String(left);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.beginPath();
    heights.forEach((tick, i) => {
      pen.moveTo(left, Math.round(y(tick)) + 0.5);
      pen.lineTo(width - right, Math.round(y(tick)) + 0.5);
      pen.fillText(texts[i], left - 6, y(tick));
    });
    factor.textContent = power === 0 ? "" : `values / 1e${power}`.replace("-", "−");
    pen.textAlign = "center";
    pen.textBaseline = "alphabetic";
    const moments = motion.still ? [0] : ticks(motion.start, motion.start + motion.end, Math.max(2, Math.floor(width / 80))).map((tick) => tick - motion.start);
    const times = clock.texts(moments);
    if (times.length > 0) times[times.length - 1] += ` ${clock.unit}`;
    moments.forEach((tick, i) => {
      const at = x(tick);
      pen.moveTo(Math.round(at) + 0.5, height - bottom);
      pen.lineTo(Math.round(at) + 0.5, height - bottom + 4);
      const half = pen.measureText(times[i]).width / 2;
      pen.fillText(times[i], Math.min(Math.max(at, left), width - half - 1), height - 4);
    });
    pen.stroke();
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    panel.curves.forEach((curve, i) => {
      pen.strokeStyle = inkOf(i);
      pen.setLineDash(dashOf(i));
      pen.beginPath();
      trace(curve, (t) => Math.round(x(t) * ratio), (t, v) => pen.lineTo(x(t), y(v)));
      pen.stroke();
    });
    pen.setLineDash([]);
  }

  function draw(time, force) {
    const [w, h, r] = look.printing ? PAPER_SIZE : [canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio];
    if (force || w !== width || h !== height || r !== ratio) {
      [width, height, ratio] = [w, h, r];
      [canvas.width, canvas.height] = [w * r, h * r];
      if (w > 0 && h > 0) paintLayer();
    }
    if (w === 0 || h === 0) return;
    const pen = canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(layer, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.strokeStyle = pageInk("--accent");
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x(time), top);
    pen.lineTo(x(time), height - bottom);
    pen.stroke();
    panel.curves.forEach((curve, i) => {
      const value = valueAt(curve, time);
      pen.fillStyle = inkOf(i);
      pen.beginPath();
      pen.arc(x(time), y(value), 3.5, 0, 2 * Math.PI);
      pen.fill();
      readings[i].data = `${curve.name} ${short(value)}`;
    });
  }

  const pick = (event) => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const inside = (event.clientX - canvas.getBoundingClientRect().left - left) / (width - left - right);
    onPick(Math.min(Math.max(inside, 0), 1) * motion.end);
  };
  canvas.addEventListener("pointerdown", pick);
  canvas.addEventListener("pointermove", pick);
  return { draw };
}
