// Panels of curves over time, with a cursor where the motion is.

/** Round numbers inside a range, about `count` of them. */
function ticks(from, to, count) {
  const step = [1, 2, 2.5, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10((to - from) / count))).find((s) => (to - from) / s <= count);
  const found = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + step * 1e-9; k += 1) found.push(k * step);
  return found;
}

function makePanel(panel, parent, onPick) {
  const figure = document.createElement("figure");
  const caption = document.createElement("figcaption");
  const heading = document.createElement("b");
  heading.textContent = panel.name;
  caption.append(heading);
  const readings = panel.curves.map((curve, i) => {
    const reading = document.createElement("span");
    reading.style.setProperty("--mark", `#${PALETTE[i % PALETTE.length].toString(16).padStart(6, "0")}`);
    caption.append(reading);
    return reading;
  });
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${panel.name} over time`);
  figure.append(caption, canvas);
  parent.append(figure);

  let [low, high] = [Infinity, -Infinity];
  for (const { values } of panel.curves) {
    for (const value of values) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  // What is constant to single precision is drawn so.
  const size = Math.max(Math.abs(low), Math.abs(high));
  const least = size > 0 ? size * 1e-5 : 1;
  if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
  const room = (high - low) * 0.06;
  [low, high] = [low - room, high + room];

  const [left, right, top, bottom] = [56, 8, 6, 20];
  const layer = document.createElement("canvas");
  let [width, height, ratio] = [0, 0, 1];
  const x = (t) => left + ((width - left - right) * t) / motion.end;
  const y = (v) => top + ((height - top - bottom) * (high - v)) / (high - low);

  /** Axes and curves, once for each size and theme. */
  function paintLayer() {
    const style = getComputedStyle(document.documentElement);
    const [ink, line] = [style.getPropertyValue("--faint"), style.getPropertyValue("--line")];
    [layer.width, layer.height] = [width * ratio, height * ratio];
    const pen = layer.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = ink;
    pen.strokeStyle = line;
    pen.lineWidth = 1;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.beginPath();
    for (const tick of ticks(low, high, 4)) {
      pen.moveTo(left, Math.round(y(tick)) + 0.5);
      pen.lineTo(width - right, Math.round(y(tick)) + 0.5);
      pen.fillText(short(Math.abs(tick) < (high - low) * 1e-9 ? 0 : tick), left - 6, y(tick));
    }
    pen.textAlign = "center";
    pen.textBaseline = "alphabetic";
    for (const tick of ticks(motion.start, motion.start + motion.end, Math.max(2, Math.floor(width / 80)))) {
      const at = x(tick - motion.start);
      pen.moveTo(Math.round(at) + 0.5, height - bottom);
      pen.lineTo(Math.round(at) + 0.5, height - bottom + 4);
      if (at < width - right - 4) pen.fillText(short(tick), Math.max(at, left), height - 4);
    }
    pen.stroke();
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    panel.curves.forEach(({ values }, i) => {
      pen.strokeStyle = readings[i].style.getPropertyValue("--mark");
      pen.beginPath();
      for (let k = 0; k < values.length; k += 1) pen.lineTo(x(motion.times[k]), y(values[k]));
      pen.stroke();
    });
  }

  function draw(time, force) {
    const [w, h, r] = [canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio];
    if (force || w !== width || h !== height || r !== ratio) {
      [width, height, ratio] = [w, h, r];
      [canvas.width, canvas.height] = [w * r, h * r];
      if (w > 0 && h > 0) paintLayer();
    }
    if (w === 0 || h === 0) return;
    const at = locate(time);
    const pen = canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(layer, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue("--accent");
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x(time), top);
    pen.lineTo(x(time), height - bottom);
    pen.stroke();
    panel.curves.forEach(({ name, values }, i) => {
      const value = between(values, 1, 0, at);
      pen.fillStyle = readings[i].style.getPropertyValue("--mark");
      pen.beginPath();
      pen.arc(x(time), y(value), 3.5, 0, 2 * Math.PI);
      pen.fill();
      readings[i].textContent = `${name} ${short(value)}`;
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
