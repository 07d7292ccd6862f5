// What is shown, out of the JSON that the exporter writes: typed arrays, and values between samples.

/** Little-endian 32-bit floats, whatever the machine's order is. */
function decode(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, k) => view.getFloat32(4 * k, true));
}

const motion = JSON.parse(document.getElementById("motion").textContent);
motion.times = decode(motion.times);
for (const body of motion.bodies) body.poses = decode(body.poses);
for (const path of motion.paths) path.points = decode(path.points);
for (const link of motion.links) link.ends = decode(link.ends);
for (const panel of motion.panels) for (const curve of panel.curves) curve.values = decode(curve.values);
for (const ground of motion.grounds) if (ground.heights) ground.heights = decode(ground.heights);
motion.end = motion.times[motion.times.length - 1];

/** The last sample not after a time, and how far it is to the next one, from 0 to 1. */
function locate(time) {
  const { times } = motion;
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const length = times[high] - times[low];
  // Times that single precision cannot tell apart make no step.
  const part = length > 0 ? Math.min(Math.max((time - times[low]) / length, 0), 1) : 1;
  return { k: low, part };
}

/** Entry `i` of `width` numbers a sample, between samples on a straight line. */
function between(values, width, i, { k, part }) {
  const a = values[k * width + i];
  return a + (values[(k + 1) * width + i] - a) * part;
}

/** The box around everything that moves: its corners. */
function box() {
  const least = new THREE.Vector3(Infinity, Infinity, Infinity);
  const most = new THREE.Vector3(-Infinity, -Infinity, -Infinity);
  const point = new THREE.Vector3();
  const add = (values, width, offset) => {
    for (let k = offset; k < values.length; k += width) {
      point.set(values[k], values[k + 1], values[k + 2]);
      least.min(point);
      most.max(point);
    }
  };
  for (const body of motion.bodies) add(body.poses, 7, 0);
  for (const path of motion.paths) add(path.points, 3, 0);
  for (const link of motion.links) add(link.ends, 3, 0);
  if (least.x > most.x) {
    least.set(-1, -1, -1);
    most.set(1, 1, 1);
  }
  return { least, most };
}

/** How far a shape reaches from the point where its body is. */
function reach(shape) {
  const [a, b = 0, c = 0] = shape.lengths;
  const own = { ring: a + b, cylinder: Math.hypot(a, b / 2), sphere: a, cuboid: Math.hypot(a, b, c) / 2, arrow: a }[shape.kind];
  return own + Math.hypot(...shape.place);
}

/** Four digits, in powers of ten where that is shorter. */
function short(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2).replace("e+", "e").replace("-", "−").replace("e-", "e−");
  return String(Number(value.toPrecision(4))).replace("-", "−");
}
