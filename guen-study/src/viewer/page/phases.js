// Words that hold for a while and marks at moments: modes of contacts and their transitions.

/** The number of the last of rising times that is not after a time; -1 if all are. */
function lastNotAfter(list, time) {
  let [low, high] = [0, list.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle].time <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Texts in one place, of which one is shown: the place is as wide as the widest of them. */
function makeOneOf(parent, texts) {
  const place = document.createElement("span");
  place.className = "one-of";
  const made = new Map([...new Set(texts)].map((text) => [text, document.createElement("span")]));
  made.forEach((element, text) => {
    element.textContent = isolated(text);
    place.append(element);
  });
  parent.append(place);
  let shown;
  return (text) => {
    if (text === shown) return;
    made.get(shown)?.classList.remove("now");
    made.get(text)?.classList.add("now");
    shown = text;
  };
}

/** Texts of more kinds than these are not laid out together: the place is as wide as the one that is shown. */
const MOST_TEXTS = 60;

/** All marks of all runs, in the order of time. */
const marks = motion.runs
  .flatMap((run, k) => (k === 0 ? motion : run).marks.map(({ time, text }) => ({ time, text: ofRun({ name: text, run: k }) })))
  .sort((a, b) => a.time - b.time);

/** The times of marks inside of a span, those that fall onto one pixel once. */
function marksIn(from, to, column) {
  const times = [];
  let last;
  for (let k = lastNotAfter(marks, from - 1e-12 * motion.end) + 1; k < marks.length && marks[k].time <= to; k += 1) {
    const here = Math.round(column(marks[k].time));
    if (here !== last) times.push(marks[k].time);
    last = here;
  }
  return times;
}

/** The mark next to a time, within a distance; nothing if there is none. */
function markNear(time, within) {
  const k = lastNotAfter(marks, time);
  const near = [marks[k], marks[k + 1]].filter((mark) => mark && Math.abs(mark.time - time) <= within);
  return near.sort((a, b) => Math.abs(a.time - time) - Math.abs(b.time - time))[0];
}

/** Lines at the slider, one for each column of which there are so many. */
const SLIDER_COLUMNS = 800;

function makePhases(setTime) {
  const bar = document.getElementById("phases");
  const words = motion.runs.flatMap((run, k) => (k === 0 ? motion : run).words.map((word) => ({ ...word, name: ofRun({ name: isolated(word.name), run: k }) })));
  bar.hidden = words.length + marks.length === 0;
  const holder = document.getElementById("words");
  const shown = words.map(({ name, changes }) => {
    const entry = document.createElement("span");
    const label = document.createElement("i");
    label.textContent = name;
    entry.append(label, " ");
    holder.append(entry, " ");
    return { changes, show: makeOneOf(entry, ["–", ...changes.map(({ text }) => text)]) };
  });
  const tell = (list, time) => list[lastNotAfter(list, time + 1e-12 * motion.end)];
  const texts = marks.map(({ text }) => text);
  const happened = document.getElementById("happened");
  const few = new Set(texts).size <= MOST_TEXTS;
  const showMark = few ? makeOneOf(happened, ["–", ...texts]) : (text) => (happened.textContent = text);
  const when = document.getElementById("when");
  when.style.minWidth = `${clock.text(motion.end).length + clock.unit.length + 4}ch`;
  document.getElementById("occasion").hidden = marks.length === 0;
  const columns = marksIn(0, motion.end, (time) => (time / motion.end) * SLIDER_COLUMNS);
  document.querySelector("#marks path").setAttribute("d", columns.map((time) => `M${((time / motion.end) * SLIDER_COLUMNS).toFixed(1)} 0 V1`).join(""));
  /** To the next mark in a direction. */
  function toMark(by, time) {
    const near = 1e-9 * motion.end;
    const to = by > 0 ? marks[lastNotAfter(marks, time + near) + 1] : marks[lastNotAfter(marks, time - near)];
    if (to) setTime(to.time);
  }
  return {
    toMark,
    draw(time) {
      for (const { changes, show } of shown) show(tell(changes, time)?.text ?? "–");
      const mark = tell(marks, time);
      showMark(mark?.text ?? "–");
      when.textContent = mark ? `t = ${clock.text(mark.time)} ${clock.unit}` : "";
    },
  };
}
