// A spring between a point of a body and a place in the world, as stiff as the body is heavy.

/** @typedef {import("../types").Scene} Scene */

export class Spring {
  constructor() {
    /** The angular frequency of the pulled body, rad/s: stiffness is its square times the effective mass at the point. */
    this.strength = 12;
    /** @type {{ body: number, point: [number, number, number], target: [number, number, number] } | null} */
    this.held = null;
    this.force = 0;
    /** @type {[number, number, number] | null} */
    this.before = null;
  }

  /** @param {NonNullable<Spring["held"]> | null} held */
  hold(held) {
    if (held?.body !== this.held?.body) this.before = null;
    this.held = held;
    if (!held) this.force = 0;
  }

  /**
   * Computes the point in the world and the force on it.
   * @param {number[]} pose position and quaternion of the body
   * @param {number} mass effective mass at the point, kg
   * @param {number} seconds since the last call
   * @returns {{ at: [number, number, number], force: [number, number, number] } | null}
   */
  apply(pose, mass, seconds) {
    if (!this.held) return null;
    const { point, target } = this.held;
    const at = /** @type {[number, number, number]} */ (transform(pose, point));
    const k = this.strength ** 2 * mass;
    const c = 1.4 * this.strength * mass;
    const before = this.before ?? at;
    const force = /** @type {[number, number, number]} */ (
      at.map((x, i) => k * (target[i] - x) - (c * (x - before[i])) / seconds)
    );
    // a pointer at the far end of the scene must not throw the infant out of it
    const most = 40 * mass * 9.81;
    const size = Math.hypot(...force);
    if (size > most) force.forEach((f, i) => (force[i] = (f * most) / size));
    this.before = at;
    this.force = Math.min(size, most);
    return { at, force };
  }
}

/**
 * @param {number[]} pose
 * @param {[number, number, number]} p
 * @returns {number[]}
 */
function transform([px, py, pz, w, a, b, c], [x, y, z]) {
  const [tx, ty, tz] = [2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)];
  return [px + x + w * tx + b * tz - c * ty, py + y + w * ty + c * tx - a * tz, pz + z + w * tz + a * ty - b * tx];
}
