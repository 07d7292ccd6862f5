// The page put together.

const byId = (id) => document.getElementById(id);
byId("title").textContent = motion.title;

const notes = motion.notes.map((note) => note.text);

let stage = null;
try {
  stage = makeStage();
  if (motion.square) notes.push(`The squares of the ground have sides of ${short(motion.square)}.`);
} catch (error) {
  const trouble = byId("trouble");
  trouble.textContent = `This browser shows no motion in space (${error.message}). The curves are here.`;
  trouble.hidden = false;
}
byId("note").textContent = notes.join(" ");
byId("note").hidden = notes.length === 0;

const legend = byId("legend");
function explain(name, colour, kind) {
  const item = document.createElement("li");
  const mark = document.createElement("i");
  mark.className = kind;
  mark.style.background = `#${new THREE.Color(colour).getHexString()}`;
  item.append(mark, document.createTextNode(name));
  legend.append(item);
}
motion.bodies.forEach((body, i) => {
  if (body.shapes.length > 0) explain(body.name, body.shapes[0].colour ?? PALETTE[i % PALETTE.length], "body");
});
motion.links.forEach((link, i) => explain(link.name, PALETTE[(motion.bodies.length + i) % PALETTE.length], "body"));
motion.paths.forEach((path, i) => explain(path.name, pathColour(i), "path"));

const panels = motion.panels
  .filter((panel) => panel.curves.length > 0)
  .map((panel) => makePanel(panel, byId("panels"), (time) => player.setTime(time)));
if (panels.length === 0) {
  byId("panels").hidden = true;
  document.querySelector("main").style.gridTemplateColumns = "minmax(0, 1fr)";
}

let repaint = true;
const player = makePlayer((time) => {
  if (stage) {
    stage.place(time);
    stage.draw();
  }
  for (const panel of panels) panel.draw(time, repaint);
  repaint = false;
});

const night = window.matchMedia("(prefers-color-scheme: dark)");
function theme() {
  if (stage) stage.theme(night.matches);
  repaint = true;
  player.request();
}
night.addEventListener("change", theme);
theme();

const follow = byId("follow");
function setFollowing(on) {
  follow.setAttribute("aria-pressed", String(stage.setFollowing(on)));
  player.request();
}
if (stage && stage.canFollow) {
  follow.addEventListener("click", () => setFollowing(follow.getAttribute("aria-pressed") !== "true"));
  if (motion.follow !== undefined) requestAnimationFrame(() => setFollowing(true));
} else {
  follow.hidden = true;
}
if (stage) {
  stage.controls.addEventListener("change", player.request);
  byId("reset").addEventListener("click", () => {
    stage.look();
    player.request();
  });
} else {
  byId("reset").hidden = true;
}
new ResizeObserver(player.request).observe(document.querySelector("main"));
// For programs that test the page.
window.guen = { motion, player };
document.documentElement.dataset.ready = "true";
