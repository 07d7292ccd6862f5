// A panel: curves over time with their legend, of which each can be switched on and off, and a cursor where the motion is.

// Width, height and pixels to a unit of a panel that is printed.
const PAPER_SIZE = [680, 150, 3];

/** Pixels between samples from which on each of them has its dot. */
const APART = 9;

/** Pixels from a mark within which the pointer reads it. */
const MARK_NEAR = 5;

/** The heading, which folds the panel, and a button for each curve with what it reads. */
function makeCaption(panel, figure, changed) {
  const caption = document.createElement("figcaption");
  const button = (className, state) => {
    const made = document.createElement("button");
    made.type = "button";
    made.className = className;
    made.setAttribute(state, "true");
    return made;
  };
  /** Whether it is so, and the other way round from now on. */
  const toggle = (element, state) => {
    const on = element.getAttribute(state) !== "true";
    element.setAttribute(state, String(on));
    return on;
  };
  const fold = button("fold", "aria-expanded");
  const heading = document.createElement("b");
  heading.textContent = panel.name;
  fold.append(heading);
  fold.title = "fold or unfold";
  const turn = () => figure.classList.toggle("folded", !toggle(fold, "aria-expanded"));
  if (panel.folded) turn();
  fold.addEventListener("click", () => {
    turn();
    changed();
  });
  caption.append(fold);
  const entries = panel.curves.map((curve) => {
    const entry = document.createElement("span");
    const shown = button("curve", "aria-pressed");
    shown.title = "show or hide";
    const mark = document.createElement("i");
    painted(() => mark.style.setProperty("background", markOf(curve)));
    shown.append(mark, document.createTextNode(curve.name));
    const value = document.createElement("data");
    entry.append(shown, value);
    caption.append(entry);
    const made = { curve, on: true, value };
    shown.addEventListener("click", () => {
      made.on = toggle(shown, "aria-pressed");
      entry.classList.toggle("off", !made.on);
      changed();
    });
    return made;
  });
  const factor = document.createElement("small");
  caption.append(factor);
  return { caption, entries, factor };
}

function makePanel(panel, parent, { span, probe, redraw, onPick }) {
  const figure = document.createElement("figure");
  const { caption, entries, factor } = makeCaption(panel, figure, redraw);
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-describedby", "plot-keys");
  canvas.tabIndex = 0;
  figure.append(caption, canvas);
  parent.append(figure);

  const whole = rangeOf(panel.curves, 0, motion.end);
  const size = Math.max(...whole.map(Math.abs));
  canvas.setAttribute("aria-label", `${panel.name} over time: ${panel.curves.map((curve) => curve.name).join(", ")}; from ${whole.map(short).join(" to ")}`);
  let [low, high] = whole;

  /** The axis fits what is shown. */
  function refit() {
    const on = entries.filter((entry) => entry.on).map((entry) => entry.curve);
    const found = rangeOf(on, span.from, span.to);
    [low, high] = found[0] <= found[1] ? found : whole;
    // What is constant to single precision is drawn so; what has a base has more digits.
    const most = Math.max(Math.abs(low), Math.abs(high));
    const least = Math.max(most * (panel.curves.some(({ base }) => base !== 0) ? 1e-13 : 1e-5), NOISE * size) || 1;
    if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
    const room = (high - low) * 0.06;
    [low, high] = [low - room, high + room];
  }

  const [right, top, bottom] = [8, 6, 20];
  let left = 48;
  const layer = document.createElement("canvas");
  let [width, height, ratio, painting] = [0, 0, 1, ""];
  const x = (t) => left + (width - left - right) * (motion.still ? 0.5 : (t - span.from) / (span.to - span.from));
  const y = (v) => top + ((height - top - bottom) * (high - v)) / (high - low);
  // In the pixels of the window, where the pointer is.
  const axis = {
    left: () => canvas.getBoundingClientRect().left + left,
    width: () => width - left - right,
    timeAt: (clientX) => span.from + ((clientX - axis.left()) / axis.width()) * (span.to - span.from),
  };

  /** Axes and curves, once for each size, theme, span and choice of curves. */
  function paintLayer() {
    refit();
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
    // For programs that test the page.
    Object.assign(canvas.dataset, { left, low, high });
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
    const moments = motion.still ? [0] : ticks(motion.start + span.from, motion.start + span.to, Math.max(2, Math.floor(width / 80))).map((tick) => tick - motion.start);
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
    pen.strokeStyle = pageInk("--edge");
    pen.setLineDash([2, 3]);
    pen.beginPath();
    for (const time of motion.still ? [] : marksIn(span.from, span.to, x)) {
      pen.moveTo(Math.round(x(time)) + 0.5, top);
      pen.lineTo(Math.round(x(time)) + 0.5, height - bottom);
    }
    pen.stroke();
    pen.setLineDash([]);
    pen.beginPath();
    pen.rect(left, 0, width - left - right + 2, height - bottom + 2);
    pen.clip();
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    for (const { curve } of entries.filter((entry) => entry.on)) {
      const [first, last] = samplesIn(curve, span.from, span.to);
      pen.strokeStyle = inkOf(curve.slot);
      pen.fillStyle = pen.strokeStyle;
      pen.setLineDash(dashOf(curve));
      pen.beginPath();
      trace(curve, [first, last], (t) => Math.round(x(t) * ratio), (t, v) => pen.lineTo(x(t), y(v)));
      pen.stroke();
      // So near that samples are apart, the page shows which it has: between them lines are straight.
      if (span.isWhole || (last - first) * APART > width) continue;
      for (let k = first; k <= last; k += 1) pen.fillRect(x(curve.times[k]) - 2, y(curve.base + curve.values[k]) - 2, 4, 4);
    }
  }

  function draw(time, force) {
    const [w, h, r] = look.printing ? PAPER_SIZE : [canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio];
    const wanted = [w, h, r, span.from, span.to, ...entries.map((entry) => entry.on)].join();
    if (force || wanted !== painting) {
      [width, height, ratio, painting] = [w, h, r, wanted];
      [canvas.width, canvas.height] = [w * r, h * r];
      if (w > 0 && h > 0) paintLayer();
    }
    const seen = probe.time ?? time;
    for (const { curve, on, value } of entries) value.textContent = !on ? "" : covers(curve, seen) ? reading(valueAt(curve, seen), size) : "–";
    if (w === 0 || h === 0) return;
    const pen = canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(layer, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const inside = (t) => t >= span.from && t <= span.to;
    const upright = (t, ink, dash) => {
      if (!inside(t)) return;
      pen.strokeStyle = pageInk(ink);
      pen.lineWidth = 1;
      pen.setLineDash(dash);
      pen.beginPath();
      pen.moveTo(x(t), top);
      pen.lineTo(x(t), height - bottom);
      pen.stroke();
    };
    upright(time, "--accent", []);
    if (probe.time !== null) upright(probe.time, "--ink", [3, 3]);
    if (probe.marked) {
      const [from, to] = probe.marked.map((t) => Math.min(Math.max(x(t), left), width - right));
      pen.fillStyle = pageInk("--accent");
      pen.globalAlpha = 0.18;
      pen.fillRect(from, top, to - from, height - top - bottom);
      pen.globalAlpha = 1;
    }
    if (!inside(seen)) return;
    for (const { curve, on } of entries) {
      if (!on || !covers(curve, seen)) continue;
      pen.fillStyle = inkOf(curve.slot);
      pen.beginPath();
      pen.arc(x(seen), y(valueAt(curve, seen)), 3.5, 0, 2 * Math.PI);
      pen.fill();
    }
    if (probe.canvas === canvas) tell(pen);
  }

  /** The time under the pointer, or how long the marked part is. */
  function tell(pen) {
    const length = probe.marked && Math.abs(probe.marked[1] - probe.marked[0]);
    const mark = length ? null : markNear(probe.time, (MARK_NEAR * (span.to - span.from)) / axis.width());
    const moment = mark ? `t = ${clock.text(mark.time)} ${clock.unit} · ${isolated(mark.text)}` : `t = ${clock.text(probe.time)} ${clock.unit}`;
    const text = length ? `Δt = ${clock.length(length)}` : moment;
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.textBaseline = "top";
    const wide = pen.measureText(text).width;
    const at = x(probe.time) + 12 + wide > width ? x(probe.time) - 8 - wide : x(probe.time) + 8;
    pen.fillStyle = pageInk("--panel");
    pen.globalAlpha = 0.85;
    pen.fillRect(at - 3, top, wide + 6, 16);
    pen.globalAlpha = 1;
    pen.fillStyle = pageInk("--ink");
    pen.fillText(text, at, top + 2);
    canvas.dataset.told = text;
  }

  listenToPlot(canvas, axis, { span, probe, redraw, onPick });
  return { draw };
}
