// Axes of bodies, and names beside what they name, for all at once or for one.

// Red, green and blue for x, y and z, in light and dark.
const AXES = [
  [0xc62828, 0xff8a80],
  [0x2e7d32, 0x81d884],
  [0x1a56c4, 0x8ab4f8],
];

/** Axes of all bodies, made when they are first asked for. */
function makeAxes(stage) {
  let made = null;
  /** An arrow of unit length along z. */
  function pointer() {
    const shaft = new THREE.CylinderGeometry(0.025, 0.025, 0.8, 10);
    const tip = new THREE.ConeGeometry(0.08, 0.22, 14);
    for (const [part, to] of [[shaft, 0.4], [tip, 0.89]]) part.rotateX(Math.PI / 2).translate(0, 0, to);
    return merged([shaft, tip]);
  }
  function make() {
    const geometry = pointer();
    const materials = AXES.map((inks) => {
      const ink = () => new THREE.Color(inks[look.dark ? 1 : 0]);
      const material = paint(ink);
      // Seen in the shade, too.
      painted(() => material.emissive.copy(ink()).multiplyScalar(0.6));
      return material;
    });
    const turns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...axis)));
    return stage.movers.map(({ group, size }) => {
      const axes = new THREE.Group();
      const length = Math.max(1.4 * size, stage.radius / 12);
      // Those of a large body are no thicker than those of others.
      const width = Math.min(length, stage.radius / 4);
      materials.forEach((material, k) => {
        const arrow = new THREE.Mesh(geometry, material);
        arrow.quaternion.copy(turns[k]);
        arrow.scale.set(width, width, length);
        axes.add(arrow);
      });
      group.add(axes);
      return { axes, length };
    });
  }
  [...document.querySelectorAll("#axis-inks b")].forEach((letter, k) => painted(() => (letter.style.color = hex(AXES[k][look.dark ? 1 : 0]))));
  return {
    show(on) {
      made ??= make();
      for (const { axes } of made) axes.visible = on;
      // For programs that test the page.
      motion.axes = on ? made.map(({ length }) => length) : null;
    },
  };
}

/** Names beside bodies and arrows. */
function makeLabels(stage) {
  const parent = document.getElementById("labels");
  const things = [
    ...stage.movers.map(({ body, group }) => ({ name: body.name, at: () => group.position, seen: () => group.visible })),
    ...stage.links.map(({ link, holder, group, middle }) => ({ name: link.name, at: () => middle, seen: () => holder.visible && group.visible && link.kind === "arrow" })),
  ];
  // Runs that stand side by side are told apart by their names above them.
  const isApart = motion.runs.some((run) => run.kind === "beside");
  const above = motion.runs.map((run, k) => {
    const { least, most } = box(k);
    const half = most.clone().sub(least).multiplyScalar(0.5);
    const up = new THREE.Vector3(...motion.up).normalize();
    return { name: isolated(run.name), always: isApart && run.kind !== "ghost", at: () => least.clone().add(half).addScaledVector(up, Math.abs(half.dot(up)) + 0.1 * stage.radius), seen: () => isApart };
  });
  things.push(...above);
  const chosen = new Set();
  let all = false;
  function element(thing) {
    const made = document.createElement("span");
    made.textContent = thing.name;
    made.dir = "auto";
    parent.append(made);
    return made;
  }
  return {
    /** The names of everything, or those that were chosen. */
    show: (on) => (all = on),
    /** The name of a body, on or off. */
    toggle: (i) => chosen.delete(i) || chosen.add(i),
    draw() {
      things.forEach((thing, i) => {
        const wanted = (all || thing.always || chosen.has(i)) && thing.seen();
        const at = wanted ? stage.onScreen(thing.at()) : null;
        if (at) {
          thing.element ??= element(thing);
          thing.element.style.transform = `translate(${Math.round(at[0])}px, ${Math.round(at[1] + 8)}px) translateX(-50%)`;
        }
        if (thing.element) thing.element.hidden = at === null;
      });
    },
  };
}

/** A button that is on or off. */
function onOff(id, does) {
  const button = document.getElementById(id);
  button.addEventListener("click", () => {
    const on = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(on));
    does(on);
  });
}
