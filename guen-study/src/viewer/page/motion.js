// What is shown, at its times, and values between samples.

motion.title = isolated(motion.title);
if (motion.follow !== undefined) motion.follow = isolated(motion.follow);
for (const panel of motion.panels) panel.name = isolated(panel.name);
motion.curves = motion.panels.flatMap((panel) => panel.curves);
const tracks = [...motion.bodies, ...motion.paths, ...motion.links, ...motion.curves];
for (const thing of tracks) {
  thing.plain = isolated(thing.name);
  thing.name = ofRun({ name: thing.plain, run: thing.run });
}
for (const run of motion.runs) run.times = decode(run.times, 8);
/** What moves and what is drawn over time has times of its own, or those of its run. */
for (const track of tracks) track.times = track.times === undefined ? motion.runs[track.run].times : decode(track.times, 8);
for (const body of motion.bodies) body.poses = decode(body.poses);
for (const path of motion.paths) path.points = decode(path.points);
for (const link of motion.links) link.ends = decode(link.ends);
for (const curve of motion.curves) {
  curve.values = decode(curve.values);
  curve.base ??= 0;
}
for (const ground of motion.grounds) if (ground.heights) ground.heights = decode(ground.heights);
motion.still = motion.runs.every(({ times }) => times.length < 2);
/** A single sample has no motion: it is shown as two alike, at one time. */
const twice = (numbers) => new numbers.constructor([...numbers, ...numbers]);
for (const run of motion.runs) if (run.times.length < 2) run.times = twice(run.times);
for (const track of tracks) {
  if (track.times.length > 1) continue;
  track.times = twice(track.times);
  for (const numbers of ["poses", "points", "ends", "values"]) if (track[numbers]) track[numbers] = twice(track[numbers]);
}
motion.times = hasGuests ? union(motion.runs.map((run) => run.times)) : motion.runs[0].times;
if (motion.still && motion.times.length < 2) motion.times = twice(motion.times);
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

/** Whether a track is at a time what it was recorded to be: a run may begin after others, or end before them. */
const covers = ({ times }, time) => time >= times[0] - 1e-9 * motion.end && time <= times[times.length - 1] + 1e-9 * motion.end;

/** Entry `i` of `width` numbers a sample, between samples on a straight line. */
function between(values, width, i, { k, part }) {
  const a = values[k * width + i];
  return a + (values[(k + 1) * width + i] - a) * part;
}

/** The box around everything that moves, or that does in one run: its corners. */
function box(run) {
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
  const of = (things) => things.filter((thing) => run === undefined || thing.run === run);
  for (const body of of(motion.bodies)) add(body.poses, 7, 0);
  for (const path of of(motion.paths)) add(path.points, 3, 0);
  for (const link of of(motion.links)) add(link.ends, 3, 0);
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

if (hasGuests) standBeside();
