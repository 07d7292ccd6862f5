// Time: playing, pausing, stepping.

function makePlayer(show) {
  const element = (id) => document.getElementById(id);
  const [play, slider, output, speed] = ["play", "slider", "time", "speed"].map(element);
  const TRIANGLE = "M5 3 L17 10 L5 17 Z";
  const BARS = "M4 3 H8 V17 H4 Z M12 3 H16 V17 H12 Z";
  const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(motion.end))));
  const state = { time: 0, playing: false };
  let last = null;
  let wanted = false;

  slider.max = String(motion.end);
  slider.step = "any";

  function request() {
    if (!wanted) {
      wanted = true;
      requestAnimationFrame(frame);
    }
  }
  function frame(now) {
    wanted = false;
    if (state.playing) {
      // A tab that was hidden goes on where it was.
      const passed = last === null ? 0 : Math.min((now - last) / 1000, 0.25);
      last = now;
      state.time += passed * Number(speed.value);
      if (state.time >= motion.end) {
        state.time = motion.end;
        setPlaying(false);
      }
      request();
    }
    slider.value = String(state.time);
    const [at, end] = [motion.start + state.time, motion.start + motion.end].map((t) => t.toFixed(digits));
    output.textContent = `t = ${at} / ${end}`;
    slider.setAttribute("aria-valuetext", `t = ${at}`);
    show(state.time);
  }
  function setPlaying(on) {
    if (on && state.time >= motion.end) state.time = 0;
    state.playing = on;
    last = null;
    play.setAttribute("aria-label", on ? "pause" : "play");
    play.querySelector("path").setAttribute("d", on ? BARS : TRIANGLE);
    document.documentElement.dataset.playing = String(on);
    request();
  }
  function setTime(time) {
    state.time = Math.min(Math.max(time, 0), motion.end);
    last = null;
    request();
  }

  play.addEventListener("click", () => setPlaying(!state.playing));
  slider.addEventListener("input", () => setTime(Number(slider.value)));
  window.addEventListener("keydown", (event) => {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = motion.end / 200;
    // A focused button would take the space bar a second time, a focused list its arrows.
    if (key === " ") {
      setPlaying(!state.playing);
    } else if (key === "ArrowRight" && target !== speed) setTime(state.time + step);
    else if (key === "ArrowLeft" && target !== speed) setTime(state.time - step);
    else if (key === "Home") setTime(0);
    else if (key === "End") setTime(motion.end);
    else if (key === "f") element("follow").click();
    else if (key === "r") element("reset").click();
    else return;
    event.preventDefault();
  });
  window.addEventListener("keyup", (event) => {
    if (event.key === " ") event.preventDefault();
  });
  setPlaying(false);
  return { setTime, setPlaying, request, state };
}
