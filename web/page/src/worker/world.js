// The world: an environment of the package, the page's requests, and its frames.
import { CONTACT, CONTACTS, layoutOf } from "../frame.js";
import { BUDGET, Clock } from "./clock.js";
import { Past } from "./past.js";
import { babbling, sine, zero } from "./policies.js";
import { Spring } from "./pull.js";
import { Tape, sameBits } from "./tape.js";

/** @typedef {import("../types").Moment} Moment */
/** @typedef {import("../types").PolicyName} PolicyName */
/** @typedef {{ policy: PolicyName, held: Record<number, number>, vigour: number, speed: number, seed: number }} Movement */
/** @typedef {import("./env.js").PageEnv} PageEnv */

/** Frames on their way: one being drawn, one behind it. */
const AHEAD = 2;
/** Frames between two scores: a score is text in the library. */
const SCORE_EVERY = 6;

export class LiveWorld {
  /**
   * @param {PageEnv} env
   * @param {Movement} movement
   * @param {{ frame: (buffer: ArrayBuffer, moment: Moment) => void, event: (name: string, data: unknown) => void, fail: (e: unknown) => void }} to
   * @param {Clock} [clock] of the world beside which it lives
   */
  constructor(env, movement, to, clock) {
    this.env = env;
    this.to = to;
    this.movement = movement;
    this.spring = new Spring();
    /** @type {Tape | null} */
    this.tape = null;
    this.past = new Past(env.actions.length, env.seconds);
    /** The moment to which time moves, after a jump. */
    /** @type {number | null} */
    this.goal = null;
    /** @type {Promise<void> | null} */
    this.travelling = null;
    /** Whether steps send no messages. */
    this.quiet = false;
    /** @type {import("./model.js").Model | null} */
    this.model = null;
    this.action = new Float32Array(env.actions.length);
    this.layout = layoutOf(env.count);
    /** @type {ArrayBuffer[]} */
    this.spare = [];
    this.away = 0;
    this.scored = 0;
    this.score = env.score();
    this.truncated = false;
    /** Whether a task has ended, so that only its next episode can continue. */
    this.over = false;
    /** The world beside this one, which follows this one's clock. */
    /** @type {LiveWorld | null} */
    this.twin = null;
    this.clock = clock ?? new Clock(
      () => this.tick(),
      () => env.seconds,
      () => this.show(),
      () => this.away < AHEAD && (this.twin?.away ?? 0) < AHEAD,
      to.fail,
    );
    this.clock.speed = movement.speed;
  }

  /** The recording that plays, if any. */
  get replay() {
    const { recording, known, at } = this.past;
    return recording && known ? { recording, done: at } : null;
  }

  /** @param {Movement} movement */
  move(movement) {
    if (differs(movement, this.movement)) this.forget();
    this.movement = movement;
    if (this.twin) this.twin.movement = { ...movement, policy: this.twin.movement.policy };
    this.clock.speed = movement.speed;
  }

  /** Fills the action from the policy, then from the held sliders. */
  decide() {
    const { policy, seed, vigour, held } = this.movement;
    const { env, action } = this;
    if (policy === "random") env.sampleAction(action);
    else if (policy === "model" && this.model) this.model.act(env, action);
    else if (policy === "babbling") babbling(seed, vigour)(env.steps, env.actions, action);
    else if (policy === "sine") sine(vigour)(env.steps, env.actions, action);
    else zero(env.steps, env.actions, action);
    for (const [i, v] of Object.entries(held)) if (Number(i) < action.length) action[Number(i)] = v;
  }

  /** One step of the clock, which pauses at the end of an episode. */
  tick() {
    if (this.over || this.twin?.over) return this.clock.play(false);
    this.step();
    this.twin?.step();
  }

  /** Stops on the way to a moment, in this world and in the one beside it. */
  stay() {
    this.goal = null;
    this.twin?.stay();
  }

  /** Clears the known future, in this world and in the one beside it. */
  forget() {
    this.goal = null;
    this.past.forget();
    this.twin?.forget();
  }

  /** Returns an error for requests that two MIMos do not support. */
  single() {
    if (this.twin) throw new Error("A recording holds one MIMo: end the comparison first.");
  }

  /** Frees the memory. */
  free() {
    this.env.free();
    this.model?.free();
    this.twin?.free();
  }

  step() {
    const { past } = this;
    const stretch = past.begin(() => ({ bytes: this.env.snapshot(), truncated: this.truncated }));
    if (past.known) this.again(stretch);
    else this.live(stretch);
  }

  /**
   * Applies the policy, the sliders and the pointer.
   * @param {import("./past.js").Stretch} stretch of the past that the step becomes part of
   */
  live(stretch) {
    const { env, action } = this;
    this.decide();
    env.clearForces();
    const pull = this.pulled();
    if (pull) env.pull(pull.body, pull.force, pull.at);
    if (this.tape && !this.tape.add(action)) this.to.event("tape", { recording: this.endRecording(), full: true });
    const over = env.step(action);
    this.past.add(stretch, action, this.movement.policy === "random", pull);
    this.end(over);
  }

  /**
   * Repeats recorded inputs.
   * @param {import("./past.js").Stretch} stretch of the past that the step is in
   */
  again(stretch) {
    const { env, past, action } = this;
    if (stretch.cut && stretch.start === past.at) this.restore(stretch);
    const { action: done, drawn, pull } = past.deed(stretch);
    if (drawn) env.sampleAction(action); // so that random numbers continue as they did
    action.set(done);
    env.clearForces();
    if (pull) env.pull(pull.body, pull.force, pull.at);
    const over = env.step(action);
    past.at++;
    this.end(over);
    if (past.recording && !past.known && !this.quiet) this.endReplay();
  }

  /** The force of the spring, if a body is held. */
  pulled() {
    const { env, spring } = this;
    const { held } = spring;
    if (!held) return null;
    const mass = 1 / Math.max(1e-3, env.bodies[held.body].invweight);
    const pulled = spring.apply(env.pose(held.body), mass, env.seconds);
    return pulled && { body: held.body, ...pulled };
  }

  /** @param {Parameters<Spring["hold"]>[0]} held */
  hold(held) {
    this.spring.hold(held);
    if (!held) this.env.clearForces();
    if (!this.clock.playing) this.show();
  }

  /**
   * Locks a joint or a part, or unlocks it.
   * @param {string} target
   * @param {boolean} on
   */
  lock(target, on) {
    this.forget();
    for (const { past } of [this, this.twin ?? this]) past.changed = true;
    this.twin?.env.lock(target, on);
    return this.env.lock(target, on);
  }

  /** @param {import("./past.js").Stretch} stretch whose snapshot is gone back to */
  restore(stretch) {
    if (!stretch.key) return;
    const locks = this.env.locked().join();
    this.env.restore(stretch.key.bytes);
    this.past.at = stretch.start;
    this.truncated = stretch.key.truncated;
    this.over = false;
    this.scored = 0;
    if (this.env.locked().join() !== locks) this.to.event("locked", this.env.locked());
  }

  /**
   * Goes to a moment of the past, or of the recording that plays, where time pauses.
   * @param {number} target steps, as in a moment's `line`
   * @returns {Promise<unknown>}
   */
  seek(target) {
    const { past } = this;
    if (this.tape) throw new Error("A recording is running: end it to go back.");
    this.clock.play(false);
    this.spring.hold(null);
    if (!past.known && past.changed) past.begin(() => ({ bytes: this.env.snapshot(), truncated: this.truncated }));
    this.goal = Math.min(past.last, Math.max(past.first, Math.round(target)));
    this.travelling ??= this.travel().finally(() => (this.travelling = null));
    return Promise.all([this.travelling, this.twin?.seek(target)]);
  }

  /** Moves time to its target, and checks messages, which may change the target. */
  async travel() {
    const { past } = this;
    let towards = -1;
    for (;;) {
      await new Promise((done) => setTimeout(done));
      if (this.goal === null || past !== this.past) return;
      if (towards !== this.goal) {
        towards = this.goal;
        const start = past.from(towards);
        if (start) this.restore(start);
      }
      if (this.towards(towards)) break;
      if (this.away < AHEAD) this.show();
    }
    this.goal = null;
    this.show();
  }

  /**
   * Steps towards a moment until it is time to check messages.
   * @param {number} target
   * @returns {boolean} whether it is reached
   */
  towards(target) {
    const { past } = this;
    const until = performance.now() + BUDGET;
    this.quiet = true;
    try {
      while (past.at < target && performance.now() < until) this.step();
    } finally {
      this.quiet = false;
    }
    if (past.at < target) return false;
    const cut = past.cut(target);
    if (cut) this.restore(cut);
    return true;
  }

  /**
   * Reports the end of an episode. A task stops there, and so does its return.
   * @param {boolean} over
   */
  end(over) {
    if (over && !this.truncated && !this.past.recording) {
      this.score = this.env.score();
      this.over = this.score.earned !== null;
      if (this.over) this.clock.play(false);
      if (!this.quiet) this.to.event("episode", { ...this.score, time: this.env.time });
    }
    this.truncated = over;
  }

  /** @param {number} n */
  steps(n) {
    this.stay();
    for (let i = 0; i < n && !this.over && !this.twin?.over; i++) this.tick();
    this.show();
  }

  /** @param {number} seed */
  reset(seed) {
    this.movement.seed = seed;
    this.settle();
    this.env.reset(seed);
    this.scored = 0;
    this.twin?.reset(seed);
  }

  /** Releases everything that belongs to a run. */
  settle() {
    this.tape = null;
    this.goal = null;
    this.past = new Past(this.action.length, this.env.seconds);
    this.truncated = this.over = false;
    this.spring.hold(null);
    this.env.clearForces();
    this.clock.debt = 0;
  }

  record() {
    this.single();
    if (this.env.locksDiffer) throw new Error("A recording holds only actions, so it needs the locks of the configuration: unlock what you locked, or choose the locks in Setup.");
    this.settle();
    const start = this.env.start();
    this.env.resetTo(start);
    this.tape = new Tape(start, this.action.length);
  }

  endRecording() {
    if (!this.tape) throw new Error("Nothing is being recorded.");
    const done = this.tape.finish(this.env.yaml, this.env.qpos());
    this.tape = null;
    return done;
  }

  /** @param {import("../types").Recording} recording */
  startReplay(recording) {
    this.single();
    if (recording.steps === 0) throw new Error("The recording has no steps.");
    const width = recording.actions.length / recording.steps;
    if (width !== this.action.length) {
      throw new Error(`The recording has ${width} actuators but this configuration has ${this.action.length}. Drop the recording's configuration (.yml) first.`);
    }
    this.settle();
    this.env.resetTo(recording);
    this.past = new Past(width, this.env.seconds, recording);
  }

  endReplay() {
    const { recording } = this.past;
    this.clock.play(false);
    if (!recording) return;
    const { end, steps } = recording;
    this.to.event("replayed", { steps, same: end && sameBits(end, this.env.qpos()) });
  }

  /** Sends a frame. */
  show() {
    const { env, layout: l } = this;
    const buffer = this.spare.pop() ?? new ArrayBuffer(4 * l.length);
    const out = new Float32Array(buffer);
    const drawn = env.refresh();
    out.set(drawn.poses, l.poses);
    out.set(drawn.bodies, l.bodies);
    out.set(drawn.felt, l.felt);
    out.set(drawn.worn, l.worn);
    const contacts = Math.min(CONTACTS, drawn.contacts.length / CONTACT);
    out.set(drawn.contacts.subarray(0, CONTACT * contacts), l.contacts);
    out.set(this.action, l.action);
    env.readJoints(out.subarray(l.angles, l.torques), out.subarray(l.torques, l.balance));
    out.set(env.balance(), l.balance);
    if (this.scored-- <= 0 || !this.clock.playing) {
      this.scored = SCORE_EVERY;
      this.score = env.score();
    }
    const { held } = this.spring;
    const { past } = this;
    this.away++;
    this.to.frame(buffer, {
      time: env.time,
      steps: env.steps,
      cost: this.clock.cost,
      pace: this.clock.pace,
      playing: this.clock.playing,
      truncated: this.truncated,
      over: this.over || this.twin?.over === true,
      contacts,
      score: this.score,
      recorded: this.tape?.steps ?? null,
      replay: this.replay && { done: this.replay.done, of: this.replay.recording.steps },
      line: { from: past.first, at: past.at, to: past.last, recording: past.recording !== null },
      memory: env.memory,
      pull: held && { body: held.body, at: held.point, force: this.spring.force },
    });
    this.twin?.show();
  }

  /** @param {ArrayBuffer} buffer a frame that was drawn */
  back(buffer) {
    this.away = Math.max(0, this.away - 1);
    if (buffer.byteLength === 4 * this.layout.length && this.spare.length < AHEAD) this.spare.push(buffer);
  }
}

/**
 * Whether two movements move MIMo differently.
 * @param {Movement} a
 * @param {Movement} b
 */
function differs(a, b) {
  const key = (/** @type {Movement} */ { policy, held, vigour, seed }) => JSON.stringify([policy, held, vigour, seed]);
  return key(a) !== key(b);
}
