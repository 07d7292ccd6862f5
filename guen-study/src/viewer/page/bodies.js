// What can be done to bodies, paths and curves: shown or hidden, chosen, followed, labelled, read.

/** The list of everything in space, with its colour. */
function makeLegend(stage, { choose, redraw }) {
  const legend = document.getElementById("legend");
  const list = legend.querySelector("ul");
  const boxes = [];
  function entry({ name, run, shapes }, kind, i) {
    const own = shapes?.[0].colour;
    const item = document.createElement("li");
    const label = document.createElement("label");
    const box = document.createElement("input");
    const mark = document.createElement("i");
    box.type = "checkbox";
    box.checked = true;
    box.setAttribute("aria-label", `show ${name}`);
    mark.className = isGhost({ run }) ? `${kind} ghost` : kind;
    painted(() => mark.style.setProperty("--mark", `#${shade(own, slots[kind](i)).getHexString()}`));
    label.append(box, mark);
    item.append(label);
    box.addEventListener("change", () => {
      stage.shown[kind](i, box.checked);
      redraw();
    });
    if (kind === "body") {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name;
      button.title = "place, velocity, and what can be done";
      button.addEventListener("click", () => choose(i));
      item.append(button);
    } else {
      label.append(document.createTextNode(name));
    }
    item.dir = "auto";
    list.append(item);
    boxes.push({ box, run, kind, i });
  }
  /** All that a run shows, on and off at once. */
  function whole(run, k) {
    const item = document.createElement("li");
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    label.append(box, document.createTextNode(isolated(run.name)));
    item.className = "run";
    item.append(label);
    list.append(item);
    box.addEventListener("change", () => boxes.forEach((other) => other.run === k && other.box.checked !== box.checked && other.box.click()));
  }
  const kinds = { body: motion.bodies.map((body) => (body.shapes.length > 0 ? body : null)), link: motion.links, path: motion.paths };
  motion.runs.forEach((run, k) => {
    if (hasGuests) whole(run, k);
    for (const kind of Object.keys(kinds)) kinds[kind].forEach((thing, i) => thing && thing.run === k && entry(thing, kind, i));
  });
  const count = list.children.length;
  legend.querySelector("summary").textContent = count > 12 ? `bodies and paths (${count})` : "bodies and paths";
  legend.hidden = count === 0 || !stage;
  // A long list would hide what it explains.
  legend.open = count <= (window.innerWidth > 760 ? 12 : 4);
  return { hide: (i) => boxes.find((entry) => entry.kind === "body" && entry.i === i)?.box.click() };
}

/** The chosen body: its place and velocity, and buttons. */
function makeCard(stage, { follow, hide, label, redraw }) {
  const card = document.getElementById("card");
  let chosen = -1;
  const rows = {};
  const element = (tag, text, className) => {
    const made = document.createElement(tag);
    made.textContent = text;
    if (className) made.className = className;
    return made;
  };
  function row(name) {
    rows[name] = element("dd", "");
    card.append(element("dt", name), rows[name]);
  }
  function button(text, does) {
    const made = element("button", text);
    made.type = "button";
    made.addEventListener("click", () => {
      does();
      redraw();
    });
    return made;
  }
  const heading = element("dd", "", "name");
  heading.dir = "auto";
  card.append(heading);
  ["place", "velocity", "speed", "turned"].forEach(row);
  const tools = element("dd", "", "does");
  tools.append(
    button("follow", () => follow(chosen)),
    button("hide", () => hide(chosen)),
    button("label", () => label(chosen)),
    button("close", () => choose(-1)),
  );
  card.append(tools);

  function choose(i) {
    chosen = i;
    card.hidden = i < 0;
    if (i >= 0) heading.textContent = motion.bodies[i].name;
    redraw();
  }
  /** Entries of a vector, of which those that are rounding beside a size read as nothing. */
  const three = (vector, size) => vector.toArray().map((entry) => reading(entry, size)).join(", ");
  const [before, after] = [new THREE.Vector3(), new THREE.Vector3()];
  function draw(time) {
    if (chosen < 0) return;
    const { group } = stage.movers[chosen];
    const { shift } = motion.runs[motion.bodies[chosen].run];
    const place = group.position.clone().add(new THREE.Vector3(...(motion.origin ?? [0, 0, 0])));
    if (shift) place.sub(shift);
    const { x, y, z, w } = group.quaternion;
    // The quotient of differences over the samples around the time.
    const [from, to] = stage.around(chosen, time, before, after);
    const velocity = after.clone().sub(before).divideScalar(to - from || 1);
    if (!covers(motion.bodies[chosen], time)) velocity.set(0, 0, 0);
    rows.place.textContent = three(place, stage.radius);
    rows.velocity.textContent = three(velocity, Math.max(velocity.length(), stage.radius / motion.end));
    rows.speed.textContent = short(velocity.length());
    const angle = 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
    rows.turned.textContent = `${((angle * 180) / Math.PI).toFixed(1)}°`;
  }
  return { choose, draw };
}
