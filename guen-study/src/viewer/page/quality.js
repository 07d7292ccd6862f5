// How finely the space is drawn while it plays: a slow machine shows a coarser picture rather than fewer ones.

/** Pixels of the picture as a part of the screen's, and shadows, from fine to coarse. */
const QUALITIES = [
  { part: 1, shadows: true },
  { part: 0.6, shadows: true },
  { part: 0.5, shadows: false },
  { part: 0.33, shadows: false },
];

/** Milliseconds of a frame above which the next coarser picture is taken, and over how many frames they are measured. */
const [SLOW, MEASURED] = [1000 / 33, 6];

function makeQuality() {
  let level = 0;
  let moments = [];
  return {
    /** The quality of the next frame. What stands still is drawn finely; what plays as the last time. */
    next(playing) {
      if (!playing) {
        moments = [];
        return QUALITIES[0];
      }
      moments.push(performance.now());
      // The first frames compile programs and make what is kept.
      if (moments.length > MEASURED + 2) {
        const taken = (moments.at(-1) - moments[2]) / (moments.length - 3);
        if (taken > SLOW && level + 1 < QUALITIES.length) {
          level += 1;
          moments = [];
        } else if (moments.length > 60) {
          moments = [];
        }
      }
      return QUALITIES[level];
    },
  };
}
