// Recordings, the actions of a run and its start, and their replay.

/** Longest recording, numbers: 64 MB. */
const MOST = 16 << 20;

export class Tape {
  /**
   * @param {{ qpos0: Float64Array, qvel0: Float64Array, activity0: Float64Array }} start
   * @param {number} width numbers of an action
   */
  constructor(start, width) {
    this.start = start;
    this.width = width;
    this.steps = 0;
    this.actions = new Float32Array(width * 1024);
  }

  /**
   * @param {Float32Array} action
   * @returns {boolean} false when the tape is full
   */
  add(action) {
    const at = this.steps * this.width;
    if (at + this.width > MOST) return false;
    if (at + this.width > this.actions.length) {
      const longer = new Float32Array(Math.min(MOST, 2 * this.actions.length));
      longer.set(this.actions);
      this.actions = longer;
    }
    this.actions.set(action, at);
    this.steps++;
    return true;
  }

  /**
   * @param {string} yaml
   * @param {Float64Array} end positions after the last step
   * @returns {import("../types").Recording}
   */
  finish(yaml, end) {
    return { ...this.start, actions: this.actions.slice(0, this.steps * this.width), steps: this.steps, yaml, end };
  }
}

/**
 * Compares two vectors bit by bit.
 * @param {Float64Array} a
 * @param {Float64Array} b
 */
export function sameBits(a, b) {
  const [x, y] = [a, b].map((v) => new BigUint64Array(v.buffer, v.byteOffset, v.length));
  return x.length === y.length && x.every((v, i) => v === y[i]);
}
