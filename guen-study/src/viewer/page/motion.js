// What is shown, out of the JSON that the exporter writes: typed arrays, and values between samples.

/** Bytes out of base64. */
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

/** Samples: base64, or what names the parts of the page where they are. */
function unpack(stored) {
  if (typeof stored === "string") return bytesOf(stored);
  const all = new Uint8Array(stored.bytes);
  let at = 0;
  for (let k = stored.from; k < stored.to; k += 1) {
    const element = document.getElementById(`part-${k}`);
    const part = bytesOf(element.textContent);
    // The text is not needed any more.
    element.remove();
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** Whether this machine orders bytes as the file does: the least significant one first. */
const littleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Numbers of `size` bytes each. */
function decode(stored, size = 4) {
  const bytes = unpack(stored);
  if (!littleEndian) for (let k = 0; k < bytes.length; k += size) bytes.subarray(k, k + size).reverse();
  return size === 8 ? new Float64Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

const motion = JSON.parse(document.getElementById("motion").textContent);
/** A name that may be written from right to left, or says so, in marks that keep its direction from what stands beside it. */
const isolated = (name) => (/[\u0590-\u08ff\u200e\u200f\u202a-\u202e\u2066-\u2069\ufb1d-\ufdff\ufe70-\ufefc]|[\ud802-\ud803\ud83a-\ud83b]/.test(name) ? `\u2068${name}\u2069` : name);
motion.title = isolated(motion.title);
if (motion.follow !== undefined) motion.follow = isolated(motion.follow);
for (const thing of [...motion.bodies, ...motion.paths, ...motion.links, ...motion.panels, ...motion.panels.flatMap((panel) => panel.curves)]) {
  thing.name = isolated(thing.name);
}
motion.times = decode(motion.times, 8);
for (const { curves } of motion.panels) curves.forEach((curve, i) => (curve.slot = i));
motion.curves = motion.panels.flatMap((panel) => panel.curves);
/** What moves and what is drawn over time has times of its own, or those of the page. */
for (const track of [...motion.bodies, ...motion.paths, ...motion.links, ...motion.curves]) {
  track.times = track.times === undefined ? motion.times : decode(track.times, 8);
}
for (const body of motion.bodies) body.poses = decode(body.poses);
for (const path of motion.paths) path.points = decode(path.points);
for (const link of motion.links) link.ends = decode(link.ends);
for (const curve of motion.curves) {
  curve.values = decode(curve.values);
  curve.base ??= 0;
}
for (const ground of motion.grounds) if (ground.heights) ground.heights = decode(ground.heights);
/** A single sample has no motion: it is shown as two alike, at one time. */
motion.still = motion.times.length < 2;
if (motion.still) {
  const twice = (numbers) => Float32Array.of(...numbers, ...numbers);
  motion.times = Float64Array.of(motion.times[0], motion.times[0]);
  for (const track of [...motion.bodies, ...motion.paths, ...motion.links, ...motion.curves]) track.times = motion.times;
  for (const body of motion.bodies) body.poses = twice(body.poses);
  for (const path of motion.paths) path.points = twice(path.points);
  for (const link of motion.links) link.ends = twice(link.ends);
  for (const curve of motion.curves) curve.values = twice(curve.values);
}
document.documentElement.dataset.still = String(motion.still);
motion.end = motion.times[motion.times.length - 1];

/** The last of the times not after a time, and how far it is to the next one, from 0 to 1. */
function locate(time, times = motion.times) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const length = times[high] - times[low];
  // Times that even double precision cannot tell apart make no step.
  const part = length > 0 ? Math.min(Math.max((time - times[low]) / length, 0), 1) : 1;
  return { k: low, part };
}

/** A curve's value at a time. */
const valueAt = (curve, time) => curve.base + between(curve.values, 1, 0, locate(time, curve.times));

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
