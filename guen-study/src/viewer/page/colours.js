// Colours of bodies, paths and curves: one list for all of them, in a tone for light paper and one for dark.

// Six hues of Okabe and Ito's kind, which stay apart for the common kinds of colour blindness; all of them have a contrast of at
// least 3:1 with what they are drawn on.
const INKS = [
  [0x0072b2, 0x56b4e9], // blue
  [0xc24a00, 0xf0883e], // vermilion
  [0x007a58, 0x2fc79a], // bluish green
  [0xa83f80, 0xe59ac5], // reddish purple
  [0x8a6400, 0xe8b64a], // ochre
  [0x4d5661, 0xb9c2cc], // grey
];
// From the seventh curve on the hues come again, dashed, and those of other runs are: lengths of lines and gaps.
const DASHES = [[], [7, 4], [2, 3], [10, 3, 2, 3]];

/** How the page looks: in the dark or on paper. */
const look = { dark: false, printing: false };

const hex = (number) => `#${number.toString(16).padStart(6, "0")}`;
const dashOf = ({ slot, run }) => DASHES[(Math.floor(slot / INKS.length) + run) % DASHES.length];

/** The colour of the thing with this number, as `#rrggbb`. */
const inkOf = (slot) => hex(INKS[slot % INKS.length][look.dark ? 1 : 0]);

/** The colour of a solid: where hues come again, farther from the background. */
function solidInk(slot) {
  const colour = new THREE.Color(inkOf(slot));
  const round = Math.floor(slot / INKS.length) % 3;
  return round === 0 ? colour : colour.lerp(new THREE.Color(look.dark ? 0xffffff : 0x000000), 0.3 * round);
}

/** The colour of a thing of its own colour, or of the list's. */
const shade = (own, slot) => (own === undefined ? solidInk(slot) : new THREE.Color(own));

const repaints = [];
/** Sets a colour, now and whenever the look changes. */
function painted(set) {
  repaints.push(set);
  set();
}

/** Luminance from 0 to 1 of a colour that the browser computed, as `rgb(r, g, b)`. */
function luminance(text) {
  const [r, g, b] = text.match(/[\d.]+/g).map((part) => {
    const c = Number(part) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Looks at what the page stands on: the system's theme, or colours that the reader forces upon it. */
function lookAgain() {
  look.printing = window.matchMedia("print").matches || look.toPaper === true;
  look.dark = !look.printing && luminance(getComputedStyle(document.getElementById("panels")).backgroundColor) < 0.18;
  for (const set of repaints) set();
}

const PAPER = { "--ink": "#000000", "--faint": "#444444", "--line": "#cccccc", "--accent": "#0b62a8" };
/** A colour of the page by its name in the style. */
const pageInk = (name) => (look.printing ? PAPER[name] : getComputedStyle(document.documentElement).getPropertyValue(name).trim());
