// What a reader takes away: a picture, the values of the curves, a film, a link to what is seen. Nothing leaves the machine.

/** The size of texts in pictures and films, in pixels of the page. */
const TEXT = 14;

/** Tells something below the picture for a while, and to who listens. */
const tell = (() => {
  const told = document.getElementById("told");
  let timer = 0;
  return (text) => {
    told.textContent = text;
    told.hidden = false;
    clearTimeout(timer);
    timer = setTimeout(() => (told.hidden = true), 8000);
  };
})();

/** Hands a file to the browser, named as the page. */
function keep(parts, type, ending) {
  const link = document.createElement("a");
  const name = motion.title.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 60) || "motion";
  link.href = URL.createObjectURL(new Blob(parts, { type }));
  link.download = `${name}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  tell(`saved as ${link.download}`);
}

/** The colour behind the space. */
const sky = () => getComputedStyle(document.getElementById("stage")).backgroundColor;

/** Draws the space with its names, the title and the time, over all of a canvas. */
function compose(canvas, space) {
  const pen = canvas.getContext("2d");
  const stageBox = document.getElementById("stage").getBoundingClientRect();
  const scale = canvas.width / stageBox.width;
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.fillStyle = sky();
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(space, 0, 0, canvas.width, canvas.height);
  pen.scale(scale, scale);
  pen.font = `${TEXT - 1.5}px system-ui, sans-serif`;
  const [ink, panel, edge] = ["--ink", "--panel", "--edge"].map((name) => getComputedStyle(document.documentElement).getPropertyValue(name));
  pen.textBaseline = "middle";
  for (const label of document.querySelectorAll("#labels span:not([hidden])")) {
    const { left, top, width, height } = label.getBoundingClientRect();
    pen.fillStyle = panel;
    pen.strokeStyle = edge;
    pen.fillRect(left - stageBox.left, top - stageBox.top, width, height);
    pen.strokeRect(left - stageBox.left, top - stageBox.top, width, height);
    pen.fillStyle = ink;
    pen.textAlign = "center";
    pen.fillText(label.textContent, left - stageBox.left + width / 2, top - stageBox.top + height / 2, width);
  }
  pen.fillStyle = ink;
  pen.textAlign = "left";
  pen.font = `${TEXT}px system-ui, sans-serif`;
  pen.fillText(motion.title, 12, stageBox.height - 34, stageBox.width - 24);
  pen.fillText(document.getElementById("paper-time").textContent, 12, stageBox.height - 14);
}

/** The plots below each other, for a page without a space. */
function composePlots(canvas) {
  const plots = [...document.querySelectorAll("figure:not(.folded)")];
  const sizes = plots.map((figure) => figure.querySelector("canvas"));
  const ratio = window.devicePixelRatio;
  const head = 24 * ratio;
  canvas.width = Math.max(1, ...sizes.map(({ width }) => width));
  canvas.height = Math.max(1, sizes.reduce((sum, { height }) => sum + height + head, 0));
  const pen = canvas.getContext("2d");
  const { backgroundColor, color } = getComputedStyle(document.getElementById("panels"));
  pen.fillStyle = backgroundColor;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.font = `${TEXT * ratio}px system-ui, sans-serif`;
  pen.textBaseline = "middle";
  pen.fillStyle = color;
  let top = 0;
  plots.forEach((figure, i) => {
    const names = [...figure.querySelectorAll(".curve[aria-pressed=true]")].map((button) => button.textContent);
    pen.fillText(`${figure.querySelector("b").textContent}: ${names.join(", ")}`, 8 * ratio, top + head / 2, canvas.width);
    pen.drawImage(sizes[i], 0, top + head);
    top += head + sizes[i].height;
  });
}

function savePicture(stage, redraw) {
  const canvas = document.createElement("canvas");
  if (stage) {
    const space = document.createElement("canvas");
    stage.print(space);
    [canvas.width, canvas.height] = [space.width, space.height];
    compose(canvas, space);
    redraw();
  } else {
    composePlots(canvas);
  }
  canvas.toBlob((blob) => keep([blob], "image/png", "png"), "image/png");
}

/** The curves as comma-separated values: every sample that the page has, blank where another curve has one and this has none. */
function saveValues() {
  const { curves, panels } = motion;
  const quoted = (text) => `"${text.replace(/"/g, '""')}"`;
  const heading = (curve) => `${panels.find((panel) => panel.curves.includes(curve)).name}: ${curve.name}`;
  const lines = [[`t in ${motion.timeUnit}`, ...curves.map(heading)].map(quoted).join(",")];
  const at = curves.map(() => 0);
  for (;;) {
    const time = Math.min(...curves.map(({ times }, i) => (at[i] < times.length ? times[at[i]] : Infinity)));
    if (time === Infinity) break;
    const row = curves.map(({ times, values, base }, i) => {
      if (times[at[i]] !== time) return "";
      at[i] += 1;
      return String(base + values[at[i] - 1]);
    });
    lines.push(`${motion.start + time},${row.join(",")}`);
  }
  keep([lines.join("\r\n"), "\r\n"], "text/csv", "csv");
}

/** Films the time that the panels show, at the pace that is chosen. */
function makeFilm({ stage, player, span }) {
  const button = document.getElementById("film");
  const words = button.textContent;
  let filming = null;
  const kind = () => ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((type) => window.MediaRecorder?.isTypeSupported(type));
  function stop() {
    const { recorder, part } = filming;
    filming = null;
    button.textContent = words;
    player.setPlaying(false);
    span.set(...part);
    // The last picture has to reach the film.
    setTimeout(() => recorder.stop(), 250);
  }
  function start() {
    const canvas = document.createElement("canvas");
    const type = kind();
    if (!type || !canvas.captureStream) {
      tell("This browser makes no films: it has no MediaRecorder for WebM. Pictures can be saved one by one.");
      return;
    }
    const { clientWidth, clientHeight } = document.getElementById("space");
    // Films have even sides.
    const even = (length) => 2 * Math.round((length * Math.min(window.devicePixelRatio, 2)) / 2);
    [canvas.width, canvas.height] = [even(clientWidth), even(clientHeight)];
    const recorder = new window.MediaRecorder(canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 8e6 });
    const parts = [];
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    recorder.addEventListener("stop", () => keep(parts, "video/webm", "webm"));
    filming = { canvas, recorder, part: [span.from, span.to] };
    button.textContent = "end the film";
    tell("The film is made while the motion plays.");
    player.setTime(span.from);
    player.setPlaying(true);
    recorder.start();
  }
  button.addEventListener("click", () => (filming ? stop() : start()));
  return {
    /** A picture was drawn: of the time that it shows. */
    frame(time) {
      if (!filming) return;
      compose(filming.canvas, document.getElementById("space"));
      if (time >= filming.part[1] || !player.state.playing) stop();
    },
  };
}
