// The page: one world, one stage, one state; the panels read it and request changes.
import { STATES } from "./announce.js";
import { BEHAVIORS } from "./names.js";
import { Recordings } from "./recordings.js";
import { sceneOf } from "./room.js";
import { Second } from "./second.js";
import { Sharing } from "./sharing.js";
import { FIRST } from "./state.js";
import { World, WorldError } from "./world.js";

/** @typedef {import("./types").PageState} PageState */
/** @typedef {import("./types").Scene} Scene */
/** @typedef {import("./types").Moment} Moment */
/** @typedef {import("./types").Settings} Settings */
/** @typedef {{ name: string, bytes: Uint8Array<ArrayBuffer>, url: string | null }} Network */
/** @typedef {"scene" | "tick" | "state" | "play" | "notice" | "over" | "eyes" | "second eyes" | "tape" | "pull"} Event */

/** Milliseconds between updates of numbers; faster updates would be unreadable. */
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
    /** Whether time runs. */
    this.playing = false;
    /** The network that the user has loaded. */
    /** @type {Network | null} */
    this.model = null;
    /** The user's own room, if any. */
    /** @type {import("./room.js").Room | null} */
    this.room = null;
    /** Asks a question with two answers. */
    /** @type {(text: string, yes: string, no: string) => Promise<boolean>} */
    this.confirm = async () => true;
    /** Whether a body is pulled. */
    this.held = false;
    /** @type {Map<Event, Set<(data: any) => void>>} */
    this.listeners = new Map();
    this.lastFrame = 0;
    this.lastTick = 0;
    /** The last world being built, if any. */
    this.turn = Promise.resolve();
    /** Changes whose world is not built yet, in order. */
    /** @type {Settings[]} */
    this.asked = [];
    /** The picture of the second MIMo. */
    this.second = new Second(this);
    this.recordings = new Recordings(this);
    this.sharing = new Sharing(this);
    this.world = this.connect(worker);
  }

  /** The settings after all requested changes are built. */
  get settings() {
    return /** @type {Settings} */ (Object.assign({}, this.state.settings, ...this.asked));
  }

  /** @param {Worker} [worker] a new one by default */
  connect(worker) {
    return new World(this.script, {
      frame: (frame, moment, second) => (second ? this.second.see(frame, moment) : this.see(frame, moment)),
      event: (name, data) => this.hear(name, data),
      died: (why) => this.announce("lost", why),
      busy: () => this.playing,
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
   * Shows a message to the user.
   * @param {string} text
   * @param {boolean} [bad]
   */
  notice(text, bad = false) {
    this.emit("notice", { name: text, text, bad });
  }

  /**
   * Announces a state. All states are announced here.
   * @param {keyof typeof STATES} name
   * @param {unknown} [data]
   */
  announce(name, data) {
    // time is paused in these, and the button must show it
    if (name === "stopped" || name === "lost" || name === "hung") this.setPlaying(false);
    this.emit("notice", { name, ...STATES[name](this, data) });
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
    else if (name === "awake") this.emit("over", "hung");
    else if (name === "tape") this.recordings.keep(data.recording, data.full);
    else if (name === "locked") this.setLocked(data);
    else this.announce(/** @type {keyof typeof STATES} */ (name), data);
  }

  /** @param {boolean} on */
  setPlaying(on) {
    this.playing = on;
    this.stage.busy = on;
    this.emit("state");
  }

  /** Starts the worker's world for the first time, from the link if it holds a state. */
  async start() {
    // not awaited: the page has graphics to prepare, and the worker continues on its own
    this.world.ask("load").then(() => performance.mark("module"), () => {});
    return this.sharing.start();
  }

  /**
   * Builds the world of these settings. Nothing changes if the library refuses them.
   * @param {Settings} settings
   * @param {Uint8Array<ArrayBuffer> | null} snapshot
   * @param {string} [yaml] the settings as a file, which may hold more than the page shows
   * @param {Uint8Array<ArrayBuffer> | null} [second] snapshot of the MIMo beside him
   * @returns {Promise<boolean>} whether it was done: not if the user chose to continue recording
   */
  async make(settings, snapshot, yaml, second) {
    if (!(await this.recordings.consent("This change"))) return false;
    await this.inTurn(() => this.build(settings, snapshot, yaml, second));
    return true;
  }

  /**
   * Builds worlds one after the other, so that each starts from the result of the previous ones.
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
   * @param {Uint8Array<ArrayBuffer> | null} [second]
   */
  async build(settings, snapshot, yaml, second) {
    const { seed, policy, held, vigour, speed, locks, twin } = this.state;
    const own = sceneOf(yaml ?? settings);
    if (own !== null && !this.room?.files[own]) throw new WorldError(`The room ${own} is not here: drop its folder on the page first.`);
    const assets = own === null ? undefined : this.room?.files;
    /** @type {Scene} */
    const scene = await this.world.ask("make", { settings: yaml ?? settings, assets, seed, policy, held: snapshot ? held : {}, vigour, speed, locks: snapshot ? [] : locks, snapshot, twin, second, network: policy === "model" || twin?.policy === "model" ? this.model?.bytes : undefined });
    if (typeof scene.alone === "string") {
      this.state.twin = null;
      this.announce("alone", scene.alone);
    }
    if (scene.misfit !== null) {
      this.state.policy = "babbling";
      this.announce("misfit", scene.misfit);
      this.move();
    }
    if (!snapshot) this.state.held = {};
    if (!this.scene) performance.mark("scene");
    this.state.settings = scene.settings;
    this.state.locks = scene.joints.filter((j) => j.locked).map((j) => j.name);
    this.show(scene);
    await this.world.ask("look");
  }

  /**
   * Builds a world from only these settings, without earlier ones.
   * @param {Settings} settings
   */
  begin(settings) {
    this.state.locks = [];
    return this.make(settings, null);
  }

  /**
   * Adds a second MIMo beside the first, or removes him. Both restart from the same seed.
   * @param {import("./types").Twin | null} twin
   */
  async compare(twin) {
    if (!(await this.recordings.consent("A comparison"))) return;
    this.emit("over", "slow");
    this.state.twin = twin;
    await this.make(this.state.settings, null);
  }

  /**
   * Loads the user's own room as the scene, with the configuration beside it, if there is one.
   * @param {import("./room.js").Room} room
   */
  async enter(room) {
    if (!(await this.recordings.consent("Another room"))) return;
    const before = this.room;
    this.room = room;
    const { behavior, age } = this.settings;
    const settings = { behavior: String(behavior) in BEHAVIORS ? behavior : "self_touch", age, vision_active: false, max_episode_steps: 12_000, scene: room.scenes[0] };
    try {
      this.state.locks = [];
      await this.make(settings, null, room.yaml ?? undefined);
    } catch (e) {
      this.room = before;
      throw e;
    }
    const others = room.scenes.filter((name) => name !== this.state.settings.scene);
    this.notice(`MIMo is in ${this.state.settings.scene} now.${others.length ? ` Other rooms beside it, for the setting scene: ${others.join(", ")}.` : ""}`);
  }

  /**
   * Changes some settings and rebuilds the world. Errors of the library are thrown.
   * @param {Settings} change
   */
  async change(change) {
    if (!(await this.recordings.consent("This change"))) return;
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

  /** Restarts a worker that died or hangs, from the state of the page. */
  async revive() {
    if (this.world.alive && !this.world.hung && !(await this.recordings.consent("A new start"))) return;
    this.connectAnew();
    await this.world.ask("load");
    await this.make(this.state.settings, null);
  }

  connectAnew() {
    this.world.stop("The simulation is started again.");
    this.turn = Promise.resolve();
    this.asked = [];
    if (this.moment) Object.assign(this.moment, { recorded: null, replay: null, over: false });
    this.setPlaying(false);
    for (const name of ["hung", "lost", "stopped"]) this.emit("over", name);
    this.world = this.connect();
  }

  /** Starts the next episode, as programs do when one ends. */
  async nextEpisode() {
    await this.reset(this.state.seed + 1);
    this.play(true);
  }

  /** @param {number} [seed] */
  async reset(seed = this.state.seed) {
    if (!(await this.recordings.consent("A reset"))) return;
    this.emit("over", "episode");
    this.emit("over", "stopped");
    this.state.seed = seed;
    await this.world.ask("reset", seed);
    this.stage.jump = true;
    if (this.second.stage) this.second.stage.jump = true;
    await this.world.ask("look");
    this.emit("state");
  }

  /**
   * Starts or pauses time. After the end of an episode the next one starts.
   * @param {boolean} on
   * @returns {Promise<void> | void}
   */
  play(on) {
    if (!this.world.alive) return this.announce("lost", "it has to be started again");
    if (on && this.moment?.over) return this.nextEpisode();
    if (on) this.emit("over", "stopped");
    this.world.tell("play", on);
    this.setPlaying(on);
  }

  /**
   * Goes to a moment of the past, or of the recording that plays; time pauses there, and continues with the same bits.
   * @param {number} step of the moment's `line`
   */
  async seek(step) {
    if (this.playing) this.setPlaying(false);
    this.emit("over", "episode");
    this.emit("over", "replayed");
    this.stage.jump = true;
    if (this.second.stage) this.second.stage.jump = true;
    await this.world.ask("seek", step);
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
  pull(pull, second = false) {
    this.held = true;
    const stage = second ? this.second.stage : this.stage;
    if (stage) stage.target = pull.target;
    this.world.tell("pull", pull, second);
    this.emit("pull");
    if (!this.playing) this.world.tell("look");
  }

  letGo(second = false) {
    this.held = false;
    const stage = second ? this.second.stage : this.stage;
    this.world.tell("pull", null, second);
    if (!stage) return;
    stage.target = null;
    stage.spring.visible = false;
    stage.invalidate();
  }

  /**
   * @param {string} part
   * @param {boolean} on
   */
  async lock(part, on) {
    this.setLocked(await this.world.ask("lock", part, on));
  }

  /** @param {boolean[]} locked of all joints */
  setLocked(locked) {
    this.scene?.joints.forEach((j, i) => (j.locked = locked[i]));
    this.state.locks = this.scene?.joints.filter((j) => j.locked).map((j) => j.name) ?? [];
    this.emit("state");
  }

  /**
   * Changes the face of MIMo and of the second MIMo. Time continues.
   * @param {string} name
   */
  async face(name) {
    await this.inTurn(async () => {
      const { scene, twin } = await this.world.ask("face", name);
      this.state.settings = scene.settings;
      this.show({ .../** @type {Scene} */ (this.scene), ...scene, twin: twin && { .../** @type {Scene} */ (this.second.scene), ...twin } });
      await this.world.ask("look");
    });
  }

  /** @param {Scene} scene */
  show(scene) {
    this.scene = scene;
    this.second.show(scene.twin ?? null);
    this.stage.build(scene);
    this.emit("scene", scene);
    this.emit("state");
  }

  /**
   * Makes a network move MIMo.
   * @param {Network} network
   */
  async bring(network) {
    const about = await this.world.ask("model", network.bytes);
    this.model = network;
    this.state.policy = "model";
    this.emit("over", "missing");
    this.move();
    if (this.state.twin?.policy === "model") await this.compare(this.state.twin);
    this.notice(`${network.name} moves MIMo now. ${about}`);
  }

  /** Sends the worker the movement settings. */
  move() {
    const { policy, held, vigour, speed, seed } = this.state;
    this.world.tell("move", { policy, held, vigour, speed, seed });
    this.emit("state");
  }

  /**
   * Runs a function and shows its error.
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
