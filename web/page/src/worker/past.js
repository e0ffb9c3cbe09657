// The past of a world: snapshots, and the inputs between them, so that every moment can be reached again with the same bits.

/** Seconds between snapshots. */
const APART = 0.5;
/** Seconds that users can go back in a live run. */
const KEPT = 30;
/** Maximum number of snapshots of a recording, which is kept whole. */
const MOST = 128;

/** @typedef {{ bytes: Uint8Array, truncated: boolean }} Key a snapshot, and other data of its moment */
/** @typedef {{ body: number, force: [number, number, number], at: [number, number, number] }} Pull */
/**
 * Steps between two snapshots. `draws` marks actions that were drawn at random; `cut` is whether something other than a step, such as a
 * lock, led to its snapshot.
 * @typedef {{ start: number, room: number, actions: Float32Array, draws: Uint8Array | null, pulls: Map<number, Pull>, key: Key | null, cut: boolean }} Stretch
 */

export class Past {
  /**
   * @param {number} width numbers of an action
   * @param {number} seconds of a step
   * @param {import("../types").Recording | null} [recording] the coming steps, if they are known
   */
  constructor(width, seconds, recording = null) {
    this.width = width;
    this.apart = Math.max(1, Math.round(APART / seconds));
    this.kept = Math.round(KEPT / seconds);
    /** The current moment of the world, and the latest known one; steps since the beginning. */
    this.at = 0;
    this.last = recording?.steps ?? 0;
    /** Whether these are only the steps of a recording. */
    this.recording = recording;
    /** Whether something other than a step has changed the world since the last step. */
    this.changed = false;
    /** @type {Stretch[]} */
    this.stretches = recording ? this.whole(recording) : [];
  }

  /** @param {import("../types").Recording} recording */
  whole({ steps, actions }) {
    const room = Math.max(this.apart, Math.ceil(steps / MOST));
    return Array.from({ length: Math.ceil(steps / room) }, (_, i) => {
      const [start, end] = [i * room, Math.min(steps, (i + 1) * room)];
      return { start, room: end - start, actions: actions.subarray(start * this.width, end * this.width), draws: null, pulls: new Map(), key: null, cut: false };
    });
  }

  /** The earliest moment that can be reached. */
  get first() {
    return Math.max(this.stretches[0]?.start ?? this.at, this.recording ? 0 : this.last - this.kept);
  }

  /** Whether the next step is known. */
  get known() {
    return this.at < this.last;
  }

  /** The stretch that the next step belongs to. */
  get here() {
    return this.stretches.findLast((s) => s.start <= this.at && this.at < s.start + s.room);
  }

  /**
   * Prepares the next step, with a snapshot at the start of a stretch.
   * @param {() => Key} save
   */
  begin(save) {
    let stretch = this.known || !this.changed ? this.here : undefined;
    if (!stretch) {
      const tail = this.stretches.at(-1);
      if (tail?.start === this.at) this.stretches.pop();
      else if (tail) tail.room = Math.min(tail.room, this.at - tail.start);
      stretch = { start: this.at, room: this.apart, actions: new Float32Array(this.apart * this.width), draws: new Uint8Array(this.apart), pulls: new Map(), key: null, cut: this.changed };
      this.stretches.push(stretch);
      this.changed = false;
    }
    stretch.key ??= save();
    return stretch;
  }

  /**
   * The recorded inputs of the next step.
   * @param {Stretch} stretch that it belongs to
   */
  deed(stretch) {
    const i = this.at - stretch.start;
    return { action: stretch.actions.subarray(i * this.width, (i + 1) * this.width), drawn: stretch.draws?.[i] === 1, pull: stretch.pulls.get(i) ?? null };
  }

  /**
   * Stores a step.
   * @param {Stretch} stretch that it belongs to
   * @param {Float32Array} action
   * @param {boolean} drawn whether it was drawn at random
   * @param {Pull | null} pull
   */
  add(stretch, action, drawn, pull) {
    const i = this.at - stretch.start;
    stretch.actions.set(action, i * this.width);
    if (stretch.draws) stretch.draws[i] = Number(drawn);
    if (pull) stretch.pulls.set(i, pull);
    this.recording = null; // the run has continued after it
    this.last = ++this.at;
    while (this.stretches.length > 1 && this.stretches[1].start <= this.last - this.kept) this.stretches.shift();
  }

  /** Clears the known future, because the run takes another course. A recording's steps remain. */
  forget() {
    if (!this.known || this.recording) return;
    this.changed = this.cut(this.at) !== null;
    this.stretches = this.stretches.filter((s) => s.start <= this.at && !(s.cut && s.start === this.at));
    const tail = this.stretches.at(-1);
    for (const i of tail?.pulls.keys() ?? []) if (tail && tail.start + i >= this.at) tail.pulls.delete(i);
    this.last = this.at;
  }

  /**
   * Returns the start of the path to a moment: the world itself, if it is nearer than a snapshot. A snapshot of the moment
   * itself is used only if no step leads there, because a step updates what a snapshot does not hold.
   * @param {number} target
   * @returns {Stretch | null} null for the current world
   */
  from(target) {
    const reached = this.stretches.filter((s) => s.key);
    const near = reached.findLast((s) => s.start < target) ?? reached.find((s) => s.start === target) ?? null;
    return near && this.at <= target && this.at >= near.start ? null : near;
  }

  /**
   * A stretch that starts at the current moment because something other than a step has changed the world.
   * @param {number} at
   */
  cut(at) {
    return this.stretches.find((s) => s.cut && s.key && s.start === at) ?? null;
  }
}
