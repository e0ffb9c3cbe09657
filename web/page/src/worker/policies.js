// Policies that move MIMo while no slider is held. They are functions of the step, so a link needs only a seed.

/** @typedef {{ low: number, high: number }} Range */
/** @typedef {(step: number, ranges: Range[], out: Float32Array) => void} Policy */

/** Step length, s, for which the rhythms below are designed. */
const STEP = 0.005;

/**
 * Returns a pseudorandom number in [-1, 1) from three whole numbers.
 * @param {number} seed
 * @param {number} which
 * @param {number} when
 */
export function noise(seed, which, when) {
  let h = Math.imul(seed ^ 0x9e3779b9, 0x85ebca6b) ^ Math.imul(which + 1, 0xc2b2ae35) ^ Math.imul(when + 1, 0x27d4eb2f);
  for (const m of [0x7feb352d, 0x846ca68b]) {
    h ^= h >>> 16;
    h = Math.imul(h, m);
  }
  return ((h ^ (h >>> 15)) >>> 0) / 2 ** 31 - 1;
}

/**
 * Maps a value of [-1, 1] to a range. Muscles only pull: their range starts at rest.
 * @param {Range} range
 * @param {number} v
 */
function into({ low, high }, v) {
  if (low >= 0) return low + (high - low) * Math.max(0, v);
  return v < 0 ? -low * v : high * v;
}

/**
 * Moves every joint smoothly from one random effort to the next, each in its own rhythm, as infants do when babbling.
 * @param {number} seed
 * @param {number} vigour 0 to 1
 * @returns {Policy}
 */
export function babbling(seed, vigour) {
  return (step, ranges, out) => {
    ranges.forEach((range, i) => {
      const period = 0.55 + 0.35 * noise(0, i, 7);
      const t = (step * STEP) / period + noise(0, i, 11);
      const k = Math.floor(t);
      const s = t - k;
      const ease = s * s * s * (s * (6 * s - 15) + 10);
      const a = noise(seed, i, k);
      out[i] = into(range, vigour * (a + (noise(seed, i, k + 1) - a) * ease));
    });
  };
}

/**
 * Swings every joint, each a little out of step with its neighbour.
 * @param {number} vigour 0 to 1
 * @returns {Policy}
 */
export function sine(vigour) {
  return (step, ranges, out) => {
    ranges.forEach((range, i) => {
      out[i] = into(range, vigour * Math.sin(2 * Math.PI * (0.5 * step * STEP + 0.618034 * i)));
    });
  };
}

/** @type {Policy} */
export const zero = (_step, ranges, out) => {
  ranges.forEach(({ low, high }, i) => (out[i] = Math.min(high, Math.max(low, 0))));
};
