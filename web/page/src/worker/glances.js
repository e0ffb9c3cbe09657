// Pictures of the eyes that wait until they are reported: vision may be late.

/** Maximum number of pictures that are kept. */
const KEPT = 256;

export class Glances {
  /** @param {number} late seconds from a picture to its report */
  constructor(late) {
    this.late = late;
    /** @type {{ time: number, pixels: Uint8ClampedArray<ArrayBuffer> }[]} */
    this.waiting = [];
  }

  /**
   * Takes the current pictures of the eyes and returns the delayed ones: the first of an episode until later ones
   * arrive.
   * @param {number} time s
   * @param {Uint8ClampedArray<ArrayBuffer>} pixels
   */
  take(time, pixels) {
    const last = this.waiting.at(-1);
    if (last && time < last.time) this.waiting = [];
    this.waiting.push({ time, pixels });
    const arrived = this.waiting.findLastIndex((w) => w.time <= time - this.late + 1e-6);
    this.waiting.splice(0, Math.max(arrived, this.waiting.length - KEPT, 0));
    const [seen] = this.waiting;
    return { pixels: seen.pixels, late: time - seen.time };
  }
}
