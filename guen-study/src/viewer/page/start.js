// The page put together.

const byId = (id) => document.getElementById(id);
byId("title").textContent = motion.title;

const notes = motion.notes.map((note) => note.text);

lookAgain();
const things = motion.bodies.length + motion.links.length + motion.paths.length;
let stage = null;
try {
  if (things > 0) stage = makeStage();
  if (motion.square) notes.push(`The squares of the ground have sides of ${short(motion.square)}.`);
} catch (error) {
  const trouble = byId("trouble");
  trouble.textContent = `This browser shows no motion in space (${error.message}). The curves are here.`;
  trouble.hidden = false;
}
byId("note").textContent = notes.join(" ");
byId("note").hidden = notes.length === 0;

const redraw = () => player.request();
const span = makeSpan(redraw);
/** What the pointer is about to read on a plot: the time, where, and the part of the time that is being marked. */
const probe = { time: null, canvas: null, marked: null };
const panels = motion.panels
  .filter((panel) => panel.curves.length > 0)
  .map((panel) => makePanel(panel, byId("panels"), { span, probe, redraw, onPick: (time) => player.setTime(time) }));
if (panels.length === 0) {
  byId("panels").hidden = true;
  document.querySelector("main").classList.add("alone");
} else if (things === 0) {
  byId("stage").hidden = true;
  document.querySelector("main").classList.add("flat");
}

let repaint = true;
let before = 0;
const phases = makePhases((time) => {
  player.setPlaying(false);
  player.setTime(time);
});
for (const [id, by] of [["mark-back", -1], ["mark-forth", 1]]) byId(id).addEventListener("click", () => phases.toMark(by, player.state.time));
const player = makePlayer((time) => {
  if (time !== before) span.follow(before, time);
  before = time;
  // What is printed is drawn once.
  if (stage && !look.printing) {
    stage.place(time);
    stage.draw(player.state.playing);
    card.draw(time);
    tags.draw();
    film.frame(time);
  }
  phases.draw(time);
  for (const panel of panels) panel.draw(time, repaint);
  repaint = false;
});

const tags = stage && makeLabels(stage);
const card = stage && makeCard(stage, { follow: (i) => setFollowing(true, i), hide: (i) => legend.hide(i), label: (i) => tags.toggle(i), redraw });
const legend = makeLegend(stage, { choose: (i) => card.choose(i), redraw });

// Light, dark, colours that are forced, paper.
function theme() {
  lookAgain();
  repaint = true;
  byId("paper").hidden = !look.printing || !stage;
  if (look.printing) {
    if (stage) {
      stage.place(player.state.time);
      stage.print(byId("paper"));
    }
    for (const panel of panels) panel.draw(player.state.time, true);
    byId("legend").open = true;
  }
  redraw();
}
for (const query of ["(prefers-color-scheme: dark)", "(forced-colors: active)", "print"]) window.matchMedia(query).addEventListener("change", theme);
window.addEventListener("beforeprint", () => {
  look.toPaper = true;
  theme();
});
window.addEventListener("afterprint", () => {
  look.toPaper = false;
  theme();
});
theme();

const follow = byId("follow");
function setFollowing(on, which) {
  follow.setAttribute("aria-pressed", String(stage.setFollowing(on, which)));
  redraw();
}
const view = byId("view");
function setView(name) {
  view.value = name;
  stage.look(name);
  redraw();
}
if (stage && stage.canFollow) {
  follow.addEventListener("click", () => setFollowing(follow.getAttribute("aria-pressed") !== "true"));
  if (motion.follow !== undefined) requestAnimationFrame(() => link.isShown || setFollowing(true));
} else {
  follow.hidden = true;
}
if (stage) {
  const axes = makeAxes(stage);
  for (const [id, made] of [["axes", axes], ["names", tags]]) {
    onOff(id, (on) => {
      made.show(on);
      redraw();
    });
  }
  byId("axes").hidden = motion.bodies.length === 0;
  // What the mouse has turned is none of the views in the list.
  stage.controls.addEventListener("start", () => (view.value = "own"));
  stage.controls.addEventListener("change", redraw);
  byId("reset").addEventListener("click", () => setView("first"));
  byId("fit").addEventListener("click", () => {
    if (follow.getAttribute("aria-pressed") === "true") setFollowing(false);
    stage.fit();
    redraw();
  });
  view.addEventListener("change", () => setView(view.value));
  // The keyboard alone gives the space its arrows; after the mouse they still set the time.
  byId("space").addEventListener("mousedown", (event) => event.preventDefault());
  // A click that turns nothing chooses the body below it.
  let pressed = null;
  byId("space").addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
  byId("space").addEventListener("click", (event) => {
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
    const bounds = byId("space").getBoundingClientRect();
    const found = stage.bodyAt(event.clientX - bounds.left, event.clientY - bounds.top);
    if (found >= 0) card.choose(found);
  });
} else {
  for (const id of ["reset", "fit", "view", "space"]) byId(id).hidden = true;
}
const menu = makeMenu();
const film = makeFilm({ stage, player, span });
const link = makeLink({ stage, player, span, setFollowing, isFollowing: () => follow.getAttribute("aria-pressed") === "true" });
byId("picture").addEventListener("click", () => savePicture(stage, redraw));
byId("values").addEventListener("click", saveValues);
byId("values").hidden = motion.curves.length === 0;
byId("film").hidden = !stage || motion.still;
link.isShown = link.read();
listenToKeys({ menu, player, phases, stage, span, setView, redraw });
new ResizeObserver(redraw).observe(document.querySelector("main"));
// For programs that test the page.
window.guen = { motion, player, stage, span, probe, look };
document.documentElement.dataset.ready = "true";
