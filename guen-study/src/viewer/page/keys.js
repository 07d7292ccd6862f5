// The keyboard: everything that the mouse does.

const VIEWS = ["first", "above", "front", "side", "below"];

function listenToKeys({ menu, player, phases, stage, span, setView, redraw }) {
  const click = (id) => () => document.getElementById(id).click();
  const step = (part) => () => player.setTime(player.state.time + part * motion.end);
  const anywhere = {
    " ": () => player.setPlaying(!player.state.playing),
    ArrowRight: step(1 / 200), ArrowLeft: step(-1 / 200),
    Home: () => player.setTime(0), End: () => player.setTime(motion.end),
    ",": () => player.toSample(-1), ".": () => player.toSample(1),
    "[": () => phases.toMark(-1, player.state.time), "]": () => phases.toMark(1, player.state.time),
    Escape: () => menu.close() || span.reset(),
    m: click("more"), p: click("picture"), v: click("values"), w: click("film"), k: click("link"), "?": click("list-keys"),
    l: click("loop"), f: click("follow"), a: click("axes"), n: click("names"), r: click("reset"), 0: click("fit"),
  };
  if (stage) {
    const nearer = (factor) => () => {
      stage.zoom(factor);
      redraw();
    };
    Object.assign(anywhere, { "+": nearer(1 / 1.2), "=": nearer(1 / 1.2), "-": nearer(1.2) });
    VIEWS.forEach((name, i) => (anywhere[i + 1] = () => setView(name)));
  }
  const ANGLE = Math.PI / 36;
  const turned = (about, towards) => () => {
    stage.turn(about * ANGLE, towards * ANGLE);
    redraw();
  };
  /** Comes nearer in time: to where the motion is, if that is shown. */
  const closer = (factor) => () => {
    const { time } = player.state;
    span.zoom(factor, time >= span.from && time <= span.to ? time : (span.from + span.to) / 2);
  };
  const inPlot = { "+": closer(1 / 1.5), "=": closer(1 / 1.5), "-": closer(1.5), 0: span.reset };
  const inPlotShifted = { ArrowLeft: () => span.pan(-0.25), ArrowRight: () => span.pan(0.25) };
  const inSpace = { ArrowLeft: turned(-1, 0), ArrowRight: turned(1, 0), ArrowUp: turned(0, 1), ArrowDown: turned(0, -1) };

  window.addEventListener("keydown", (event) => {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]")) return;
    // Lists have their own keys, buttons and marks their space bar, the slider its own steps.
    if (target.matches("select")) return;
    if (key === " " && target.matches("button, summary, input[type=checkbox]")) return;
    if (target.matches("#panels, #legend, #legend *") && (key === "Home" || key === "End")) return;
    const isPlot = target.matches("#panels canvas");
    const own = isPlot ? (event.shiftKey && inPlotShifted[key]) || inPlot[key] : target.id === "space" && stage && inSpace[key];
    const does = own || anywhere[key];
    if (!does) return;
    does();
    event.preventDefault();
  });
  // A button that the mouse has pressed leaves the space bar to the player.
  document.addEventListener("click", (event) => {
    const button = event.target.closest?.("button");
    if (button && event.detail > 0) button.blur();
  });
}
