// Time: playing, pausing, stepping.

function makePlayer(show) {
  const element = (id) => document.getElementById(id);
  const [play, slider, output, speed, loop, said] = ["play", "slider", "time", "speed", "loop", "said"].map(element);
  const TRIANGLE = "M5 3 L17 10 L5 17 Z";
  const BARS = "M4 3 H8 V17 H4 Z M12 3 H16 V17 H12 Z";
  offerPaces(speed);
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
        const again = loop.getAttribute("aria-pressed") === "true";
        state.time = again ? state.time % motion.end : motion.end;
        if (!again) setPlaying(false);
      }
      request();
    }
    slider.value = String(state.time);
    const [at, end] = [state.time, motion.end].map(clock.text);
    output.textContent = motion.still ? `t = ${at} ${clock.unit}` : `t = ${at} / ${end} ${clock.unit}`;
    // Not in every frame: somebody listens to it.
    if (!state.playing) slider.setAttribute("aria-valuetext", `t = ${at} ${clock.unit}`);
    element("paper-time").textContent = `t = ${at} ${clock.unit}`;
    show(state.time);
  }
  function setPlaying(on) {
    if (on && state.time >= motion.end) state.time = 0;
    if (state.playing !== on) said.textContent = on ? "plays" : "pauses";
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
  /** To another sample: the next one in a direction. */
  function toSample(by) {
    setPlaying(false);
    const { k } = locate(state.time);
    const { times } = motion;
    // Between samples, and at the last one, the sample before is the one back.
    const near = 1e-9 * motion.end;
    let to = k;
    while (by > 0 && to < times.length - 1 && times[to] <= state.time + near) to += 1;
    if (by < 0) for (to = Math.min(k + 1, times.length - 1); to > 0 && times[to] >= state.time - near;) to -= 1;
    setTime(times[to]);
  }
  element("back").addEventListener("click", () => toSample(-1));
  element("forth").addEventListener("click", () => toSample(1));
  loop.addEventListener("click", () => loop.setAttribute("aria-pressed", String(loop.getAttribute("aria-pressed") !== "true")));
  setPlaying(false);
  said.textContent = "";
  return { setTime, setPlaying, toSample, request, state };
}
