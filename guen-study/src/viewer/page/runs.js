// Several runs on one page: what they show, joined, with the names of their runs and one clock.

const firstRun = { name: motion.run, kind: "first", times: motion.times };
motion.runs = [firstRun, ...motion.guests];
const hasGuests = motion.guests.length > 0;

/** Things of a kind: those of the first run, then those of its guests, each with its run and the one of the first run with its name. */
function joined(kind) {
  const own = motion[kind];
  const twin = (thing) => own.findIndex(({ name }) => name === thing.name);
  const guests = motion.guests.flatMap((guest, k) => guest[kind].map((thing) => ({ ...thing, run: k + 1, like: twin(thing) })));
  own.forEach((thing) => (thing.run = 0));
  return [...own, ...guests];
}

/** Curves of guests go into the panel of their heading, with the colour of the curve of their name. */
function joinPanels() {
  for (const { curves } of motion.panels) curves.forEach((curve, i) => Object.assign(curve, { slot: i, run: 0 }));
  motion.guests.forEach((guest, k) => {
    for (const panel of guest.panels) {
      let into = motion.panels.find(({ name }) => name === panel.name);
      if (!into) motion.panels.push((into = { ...panel, curves: [] }));
      let free = Math.max(-1, ...into.curves.map(({ slot }) => slot));
      for (const curve of panel.curves) {
        const like = into.curves.find(({ name }) => name === curve.name);
        into.curves.push({ ...curve, run: k + 1, slot: like ? like.slot : (free += 1) });
      }
    }
  });
}

/** The number of things of the first run: colours of others come after them. */
motion.own = Object.fromEntries(["bodies", "links", "paths"].map((kind) => [kind, motion[kind].length]));
for (const kind of ["bodies", "links", "paths"]) motion[kind] = joined(kind);
joinPanels();
/** Whether a thing is drawn faintly. */
const isGhost = ({ run }) => motion.runs[run].kind === "ghost";
/** A name with that of its run. */
const ofRun = ({ name, run }) => (hasGuests ? `${name} · ${isolated(motion.runs[run].name)}` : name);

/** All times of several runs, rising; those that are one but for rounding are one. */
function union(lists) {
  const all = Float64Array.from(lists.flatMap((times) => [...times])).sort();
  const near = 1e-9 * all[all.length - 1];
  return all.filter((time, k) => k === 0 || time - all[k - 1] > near);
}

/** The direction in which the page is seen at first, from the motion to the eye. */
function firstDirection() {
  if (motion.from) return new THREE.Vector3(...motion.from);
  const level = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...motion.up).normalize());
  return new THREE.Vector3(-0.75, -1.25, 0.8).applyQuaternion(level);
}

/** Moves runs that stand beside the first one to the right of it, by what all of them take up. */
function standBeside() {
  const right = new THREE.Vector3(...motion.up).cross(firstDirection()).normalize();
  if (!(right.length() > 0)) return;
  /** From where to where a run reaches along the direction to the right. */
  const extent = (run) => {
    let [from, to] = [Infinity, -Infinity];
    eachPlace(run, (numbers, k, reached) => {
      const at = right.x * numbers[k] + right.y * numbers[k + 1] + right.z * numbers[k + 2];
      from = Math.min(from, at - reached);
      to = Math.max(to, at + reached);
    });
    return [from, to];
  };
  const ghosts = motion.runs.map((run, k) => k).filter((k) => motion.runs[k].kind !== "beside");
  let edge = Math.max(...ghosts.map((k) => extent(k)[1]));
  motion.runs.forEach((run, k) => {
    if (run.kind !== "beside") return;
    const [from, to] = extent(k);
    if (!(to >= from)) return;
    run.shift = right.clone().multiplyScalar(edge - from + Math.max(to - from, 1e-9) * 0.2);
    eachPlace(k, (numbers, at) => run.shift.toArray().forEach((by, i) => (numbers[at + i] += by)));
    edge = extent(k)[1];
  });
}

/** Visits all places of a run: the numbers, where in them the place begins, and how far around it things are drawn. */
function eachPlace(run, visit) {
  for (const body of motion.bodies) {
    if (body.run !== run) continue;
    const reached = Math.max(0, ...body.shapes.map(reach));
    for (let k = 0; k < body.poses.length; k += 7) visit(body.poses, k, reached);
  }
  for (const path of motion.paths) if (path.run === run) for (let k = 0; k < path.points.length; k += 3) visit(path.points, k, 0);
  for (const link of motion.links) if (link.run === run) for (let k = 0; k < link.ends.length; k += 3) visit(link.ends, k, link.radius);
}
