// The world: an environment of the package, what the page wants of it, and a frame of it.
import { CONTACT, CONTACTS, layoutOf } from "../frame.js";
import { Clock } from "./clock.js";
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
   */
  constructor(env, movement, to) {
    this.env = env;
    this.to = to;
    this.movement = movement;
    this.spring = new Spring();
    /** @type {Tape | null} */
    this.tape = null;
    /** @type {{ recording: import("../types").Recording, done: number } | null} */
    this.replay = null;
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
    /** Whether a task has ended: it goes on with its next episode only. */
    this.over = false;
    this.clock = new Clock(
      () => this.step(),
      () => env.seconds,
      () => this.show(),
      () => this.away < AHEAD,
      to.fail,
    );
    this.clock.speed = movement.speed;
  }

  /** @param {Movement} movement */
  move(movement) {
    this.movement = movement;
    this.clock.speed = movement.speed;
  }

  /** Fills the action from the policy, then from what is held. */
  decide() {
    const { policy, seed, vigour, held } = this.movement;
    const { env, action } = this;
    if (this.replay) {
      const { recording, done } = this.replay;
      const width = action.length;
      action.set(recording.actions.subarray(done * width, (done + 1) * width));
      return;
    }
    if (policy === "random") env.sampleAction(action);
    else if (policy === "model" && this.model) this.model.act(env, action);
    else if (policy === "babbling") babbling(seed, vigour)(env.steps, env.actions, action);
    else if (policy === "sine") sine(vigour)(env.steps, env.actions, action);
    else zero(env.steps, env.actions, action);
    for (const [i, v] of Object.entries(held)) if (Number(i) < action.length) action[Number(i)] = v;
  }

  step() {
    const { env, spring } = this;
    if (this.over) return this.clock.play(false);
    this.decide();
    env.clearForces();
    const held = spring.held;
    if (held) {
      const mass = 1 / Math.max(1e-3, env.bodies[held.body].invweight);
      const pulled = spring.apply(env.pose(held.body), mass, env.seconds);
      if (pulled) env.pull(held.body, pulled.force, pulled.at);
    }
    if (this.tape && !this.tape.add(this.action)) this.to.event("tape", { recording: this.endRecording(), full: true });
    this.end(env.step(this.action));
    if (this.replay && ++this.replay.done >= this.replay.recording.steps) this.endReplay();
  }

  /**
   * Tells when an episode is over; a task stops there, so that its return does.
   * @param {boolean} over
   */
  end(over) {
    if (over && !this.truncated && !this.replay) {
      this.score = this.env.score();
      this.over = this.score.earned !== null;
      if (this.over) this.clock.play(false);
      this.to.event("episode", { ...this.score, time: this.env.time });
    }
    this.truncated = over;
  }

  /** @param {number} n */
  steps(n) {
    for (let i = 0; i < n && !this.over; i++) this.step();
    this.show();
  }

  /** @param {number} seed */
  reset(seed) {
    this.movement.seed = seed;
    this.settle();
    this.env.reset(seed);
    this.scored = 0;
  }

  /** Lets go of everything that belongs to a run. */
  settle() {
    this.tape = this.replay = null;
    this.truncated = this.over = false;
    this.spring.hold(null);
    this.env.clearForces();
    this.clock.debt = 0;
  }

  record() {
    if (this.env.locksDiffer) throw new Error("A recording knows actions only, so it needs the locks of the configuration: unlock what you locked, or choose the locks in Setup.");
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
    if (recording.steps === 0) throw new Error("The recording has no steps.");
    const width = recording.actions.length / recording.steps;
    if (width !== this.action.length) {
      throw new Error(`The recording has ${width} actuators but this configuration has ${this.action.length}. Drop the recording's configuration (.yml) first.`);
    }
    this.settle();
    this.env.resetTo(recording);
    this.replay = { recording, done: 0 };
  }

  endReplay() {
    const replay = this.replay;
    this.replay = null;
    this.clock.play(false);
    if (!replay) return;
    const { end, steps } = replay.recording;
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
    this.away++;
    this.to.frame(buffer, {
      time: env.time,
      steps: env.steps,
      cost: this.clock.cost,
      pace: this.clock.pace,
      playing: this.clock.playing,
      truncated: this.truncated,
      over: this.over,
      contacts,
      score: this.score,
      recorded: this.tape?.steps ?? null,
      replay: this.replay && { done: this.replay.done, of: this.replay.recording.steps },
      memory: env.memory,
      pull: held && { body: held.body, at: held.point, force: this.spring.force },
    });
  }

  /** @param {ArrayBuffer} buffer a frame that was drawn */
  back(buffer) {
    this.away = Math.max(0, this.away - 1);
    if (buffer.byteLength === 4 * this.layout.length && this.spare.length < AHEAD) this.spare.push(buffer);
  }
}
