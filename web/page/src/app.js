// What the page is: one world, one stage, one state; the panels look at it and ask it to change.
import { World, WorldError } from "./world.js";
import * as link from "./link.js";

/** @typedef {import("./types").PageState} PageState */
/** @typedef {import("./types").Scene} Scene */
/** @typedef {import("./types").Moment} Moment */
/** @typedef {import("./types").Settings} Settings */
/** @typedef {"scene" | "tick" | "state" | "play" | "notice" | "eyes" | "tape" | "fault"} Event */

/** What a first visitor sees: an infant in its cot, all senses on. */
/** @type {PageState} */
const FIRST = {
  settings: { behavior: "self_touch", scene: "crib", vision_active: false, max_episode_steps: 12_000 },
  seed: 0,
  policy: "babbling",
  held: {},
  vigour: 0.6,
  speed: 1,
  locks: [],
};

/** Milliseconds between looks at numbers: faster than one reads. */
const TICK = 100;

export class App {
  /**
   * @param {import("./stage/stage.js").Stage} stage
   * @param {URL} script of the worker
   * @param {Worker} worker
   */
  constructor(stage, script, worker) {
    this.stage = stage;
    this.script = script;
    /** @type {PageState} */
    this.state = structuredClone(FIRST);
    /** @type {Scene | null} */
    this.scene = null;
    /** @type {Moment | null} */
    this.moment = null;
    this.frame = new Float32Array(0);
    this.playing = false;
    /** Whether something is pulled. */
    this.held = false;
    /** @type {Map<Event, Set<(data: any) => void>>} */
    this.listeners = new Map();
    this.lastFrame = 0;
    this.lastTick = 0;
    /** The last world that is being built, if one is. */
    this.turn = Promise.resolve();
    /** Changes that wait for their world, the first of them first. */
    /** @type {Settings[]} */
    this.asked = [];
    this.world = this.connect(worker);
  }

  /** The settings as they will be when everything that was asked for is built. */
  get settings() {
    return /** @type {Settings} */ (Object.assign({}, this.state.settings, ...this.asked));
  }

  /** @param {Worker} [worker] a new one by default */
  connect(worker) {
    return new World(this.script, {
      frame: (frame, moment) => this.see(frame, moment),
      event: (name, data) => this.hear(name, data),
      died: (why) => this.emit("fault", why),
    }, worker);
  }

  /**
   * @param {Event} name
   * @param {(data: any) => void} listener
   */
  on(name, listener) {
    const all = this.listeners.get(name) ?? new Set();
    all.add(listener);
    this.listeners.set(name, all);
  }

  /**
   * @param {Event} name
   * @param {unknown} [data]
   */
  emit(name, data) {
    for (const listener of this.listeners.get(name) ?? []) listener(data);
  }

  /**
   * Shows a message to the person.
   * @param {string} text
   * @param {boolean} [bad]
   */
  notice(text, bad = false) {
    this.emit("notice", { text, bad });
  }

  /**
   * @param {Float32Array} frame
   * @param {Moment} moment
   */
  see(frame, moment) {
    const now = performance.now();
    const seconds = Math.min(0.1, (now - this.lastFrame) / 1000);
    this.lastFrame = now;
    this.moment = moment;
    if (this.frame.length !== frame.length) this.frame = new Float32Array(frame.length);
    this.frame.set(frame);
    if (moment.playing !== this.playing) this.setPlaying(moment.playing);
    this.stage.show(frame, moment, moment.playing ? seconds : 0.5);
    this.emit("play", moment);
    if (now - this.lastTick > TICK || !moment.playing) {
      this.lastTick = now;
      this.emit("tick", moment);
    }
  }

  /**
   * @param {string} name
   * @param {any} data
   */
  hear(name, data) {
    if (name === "error") this.notice(data, true);
    else if (name === "slow") this.notice("The simulation has not answered for a while. It may be busy; it can be started again in the tab Setup.", true);
    else if (name === "note") this.notice(data);
    else this.emit(/** @type {Event} */ (name), data);
  }

  /** @param {boolean} on */
  setPlaying(on) {
    this.playing = on;
    this.stage.busy = on;
    this.emit("state");
  }

  /** Starts the worker's world for the first time, from the link if it holds a state. */
  async start() {
    // not waited for: the page has graphics to prepare, and the worker goes on by itself
    this.world.ask("load").then(() => performance.mark("module"), () => {});
    let opened = null;
    try {
      opened = await link.decode(location.hash);
    } catch {
      this.notice("The link is damaged. The page starts afresh.", true);
    }
    if (opened) {
      const { state, snapshot } = opened;
      this.state = { ...structuredClone(FIRST), ...state };
      try {
        await this.make(this.state.settings, snapshot);
        if (this.state.view) this.stage.orbit.view = this.state.view;
        return Boolean(snapshot);
      } catch (e) {
        this.notice(`The link cannot be opened: ${/** @type {Error} */ (e).message}`, true);
        this.state = structuredClone(FIRST);
      }
    }
    await this.make(this.state.settings, null);
    return false;
  }

  /**
   * Builds the world of these settings. Nothing changes if the library refuses them.
   * @param {Settings} settings
   * @param {Uint8Array<ArrayBuffer> | null} snapshot
   * @param {string} [yaml] the settings as a file, which may hold more than the page shows
   */
  make(settings, snapshot, yaml) {
    return this.inTurn(() => this.build(settings, snapshot, yaml));
  }

  /**
   * Builds worlds one after the other, so that each starts from what those before it left.
   * @param {() => Promise<void>} work
   */
  inTurn(work) {
    const done = this.turn.then(work);
    this.turn = done.catch(() => {});
    return done;
  }

  /**
   * @param {Settings} settings
   * @param {Uint8Array<ArrayBuffer> | null} snapshot
   * @param {string} [yaml]
   */
  async build(settings, snapshot, yaml) {
    const { seed, policy, held, vigour, speed, locks } = this.state;
    /** @type {Scene} */
    const scene = await this.world.ask("make", { settings: yaml ?? settings, seed, policy, held: snapshot ? held : {}, vigour, speed, locks: snapshot ? [] : locks, snapshot });
    if (!snapshot) this.state.held = {};
    if (!this.scene) performance.mark("scene");
    this.scene = scene;
    this.state.settings = scene.settings;
    this.state.locks = scene.joints.filter((j) => j.locked).map((j) => j.name);
    this.stage.build(scene);
    this.emit("scene", scene);
    this.emit("state");
    await this.world.ask("look");
  }

  /**
   * Builds a world of these settings alone, without what was set before.
   * @param {Settings} settings
   */
  async begin(settings) {
    this.state.locks = [];
    await this.make(settings, null);
  }

  /**
   * Changes some settings and builds anew; errors of the library are thrown.
   * @param {Settings} change
   */
  async change(change) {
    this.asked.push(change);
    try {
      await this.inTurn(() => {
        this.state.locks = [];
        return this.build({ ...this.state.settings, ...change }, null);
      });
    } finally {
      this.asked = this.asked.filter((other) => other !== change);
      this.emit("state");
    }
  }

  /** Starts the worker again after it died, with what the page knows. */
  async revive() {
    this.world.stop();
    this.turn = Promise.resolve();
    this.asked = [];
    this.world = this.connect();
    await this.world.ask("load");
    await this.make(this.state.settings, null);
  }

  /** @param {number} [seed] */
  async reset(seed = this.state.seed) {
    this.state.seed = seed;
    await this.world.ask("reset", seed);
    this.stage.jump = true;
    await this.world.ask("look");
    this.emit("state");
  }

  /** @param {boolean} on */
  play(on) {
    this.world.tell("play", on);
    this.setPlaying(on);
  }

  /**
   * Whether a body can be pulled: it moves, and no recording or replay runs.
   * @param {number} body
   */
  movable(body) {
    if (!this.scene || this.moment?.recorded != null || this.moment?.replay) return false;
    return body > 0 && this.scene.bodies[body].movable;
  }

  /** @param {{ body: number, point: [number, number, number], target: [number, number, number] }} pull */
  pull(pull) {
    this.held = true;
    this.stage.target = pull.target;
    this.world.tell("pull", pull);
    if (!this.playing) this.world.tell("look");
  }

  letGo() {
    this.held = false;
    this.stage.target = null;
    this.stage.spring.visible = false;
    this.world.tell("pull", null);
    this.stage.invalidate();
  }

  /**
   * @param {string} part
   * @param {boolean} on
   */
  async lock(part, on) {
    const locked = await this.world.ask("lock", part, on);
    this.scene?.joints.forEach((j, i) => (j.locked = locked[i]));
    this.state.locks = this.scene?.joints.filter((j) => j.locked).map((j) => j.name) ?? [];
    this.emit("state");
  }

  /** Lets the worker know what the state says about movement. */
  move() {
    const { policy, held, vigour, speed, seed } = this.state;
    this.world.tell("move", { policy, held, vigour, speed, seed });
    this.emit("state");
  }

  /**
   * Returns the address of the page with its state.
   * @param {boolean} withMoment whether it continues from this very moment
   */
  async address(withMoment) {
    const snapshot = withMoment ? await this.world.ask("snapshot") : null;
    const state = { ...this.state, settings: this.scene ? this.scene.changed : this.state.settings, view: this.stage.orbit.view };
    const fragment = await link.encode(state, snapshot);
    return new URL(`#${fragment}`, location.href).href;
  }

  /**
   * Runs something and says what went wrong.
   * @param {() => Promise<unknown> | void} task
   */
  async attempt(task) {
    try {
      await task();
      return true;
    } catch (e) {
      this.notice(e instanceof Error ? e.message : String(e), true);
      if (!(e instanceof WorldError)) console.error(e);
      return false;
    }
  }
}
