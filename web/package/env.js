// One environment.
import { Blueprint } from "./blueprint.js";
import { guarded } from "./errors.js";
import { module } from "./module.js";

/** @typedef {import("./types.js").Observation} Observation */
/** @typedef {Float32Array | Float64Array | Int32Array | Uint8Array} Numbers */

const KINDS = /** @type {const} */ ({ 1: Uint8Array, 4: Float32Array, 5: Int32Array, 8: Float64Array });
/** The observation, by the names of its views. */
const SENSES = [
  "proprioception", "touch", "touch_pooled", "pain", "vestibular", "achieved_goal", "desired_goal",
  ...["", "_gray", "_depth", "_segmentation"].flatMap((kind) => [`eye_left${kind}`, `eye_right${kind}`]),
];

/**
 * An environment. Numbers are views on the module's memory, without copies: they change with the next step.
 *
 * ```js
 * import init, { Env } from "babybench";
 * await init();
 * const env = new Env({ behavior: "self_touch", scene: "crib" });
 * env.reset(0);
 * const { observation, truncated } = env.step(env.sampleAction());
 * ```
 */
export class Env {
  #core;
  /** @type {Map<string, Numbers>} */
  #views = new Map();
  /** @type {import("./types.js").Config} */
  #config;
  #yaml;
  /** @type {Observation} */
  #observation;
  /** @type {import("./types.js").Model | undefined} */
  #model;
  /** @type {import("./types.js").Look | undefined} */
  #look;

  /**
   * Builds the scene of a configuration, or makes one more environment of a blueprint.
   * @param {import("./types.js").Settings | string | Blueprint} [config] values by key, or the text of a YAML file
   * @param {string} [name] of the file, for errors
   */
  constructor(config = {}, name) {
    const shared = config instanceof Blueprint;
    const blueprint = shared ? config : new Blueprint(config, name);
    try {
      this.#core = guarded(() => blueprint.core.env());
      this.#config = blueprint.config;
      this.#yaml = blueprint.yaml;
    } finally {
      if (!shared) blueprint.free();
    }
    const env = this;
    const getters = SENSES.map((name) => [name, { enumerable: true, get: () => env.view(name) }]);
    this.#observation = Object.defineProperties(/** @type {any} */ ({}), Object.fromEntries(getters));
  }

  /** The complete configuration by key. */
  get config() {
    return this.#config;
  }

  /** The complete configuration, as the text of a YAML file. */
  get yaml() {
    return this.#yaml;
  }

  /**
   * Starts an episode. The same seed gives the same episode.
   * @param {number | bigint} [seed]
   */
  reset(seed) {
    guarded(() => this.#core.reset(seed === undefined ? undefined : BigInt(seed)));
    return this.observation;
  }

  /**
   * Starts an episode from positions (nq) and velocities (nv).
   * @param {ArrayLike<number>} qpos
   * @param {ArrayLike<number>} qvel
   */
  resetTo(qpos, qvel) {
    guarded(() => this.#core.resetTo(Float64Array.from(qpos), Float64Array.from(qvel)));
    return this.observation;
  }

  /**
   * Sets positions and velocities in the middle of an episode.
   * @param {ArrayLike<number>} qpos
   * @param {ArrayLike<number>} qvel
   */
  setState(qpos, qvel) {
    guarded(() => this.#core.setState(Float64Array.from(qpos), Float64Array.from(qvel)));
    return this.observation;
  }

  /**
   * Sets the activations of the muscles.
   * @param {ArrayLike<number>} activity
   */
  setActivity(activity) {
    guarded(() => this.#core.setActivity(Float64Array.from(activity)));
  }

  /**
   * Steps with an action; without one, with what is written in {@link Env.action}.
   * @param {ArrayLike<number>} [action]
   * @returns {import("./types.js").Step}
   */
  step(action) {
    const own = this.action;
    if (action !== undefined && action !== own) {
      if (action.length !== own.length) {
        throw new Error(`the action has ${action.length} values but the action space has ${own.length}`);
      }
      own.set(action);
    }
    guarded(() => this.#core.step());
    const env = this;
    return {
      observation: this.observation,
      reward: this.#core.reward(),
      terminated: this.#core.terminated(),
      truncated: this.#core.truncated(),
      get info() {
        return env.info; // made when it is read: most steps need none
      },
    };
  }

  /**
   * Changes the desired goal of this episode.
   * @param {ArrayLike<number>} desired
   */
  setGoal(desired) {
    guarded(() => this.#core.setGoal(Float64Array.from(desired)));
    return this.observation;
  }

  /**
   * Computes what rows of goals would have earned; for the goals of a step it is the reward of the step.
   * @param {ArrayLike<number>[]} achieved
   * @param {ArrayLike<number>[]} desired
   * @param {{ reward_terms: number[] | null }[]} infos those of the steps
   * @returns {Float64Array} a reward for each row
   */
  computeReward(achieved, desired, infos) {
    const flat = (/** @type {ArrayLike<number>[]} */ rows) => Float64Array.from(rows.flatMap((row) => Array.from(row)));
    const terms = flat(infos.map((info) => info.reward_terms ?? []));
    return guarded(() => this.#core.computeReward(flat(achieved), flat(desired), terms, achieved.length));
  }

  /** The next action, to write into. */
  get action() {
    return /** @type {Float32Array} */ (this.view("action"));
  }

  /** Fills {@link Env.action} with a random action, the one that Gymnasium draws from the same seed, and returns it. */
  sampleAction() {
    guarded(() => this.#core.sampleAction());
    return this.action;
  }

  /**
   * Seeds the random actions.
   * @param {number | bigint} seed
   */
  seedActionSpace(seed) {
    guarded(() => this.#core.seedActionSpace(BigInt(seed)));
  }

  /** What MIMo senses since the last reset or step. Its views are made when they are read, so that they are always valid. */
  get observation() {
    return this.#observation;
  }

  /**
   * Returns a view of numbers by name: of the observation, or of the state by MuJoCo's names (`qpos`, `xpos`,
   * `geom_xmat`, `actuator_force` ...). It is valid until the module's memory grows or a snapshot is restored.
   * @param {string} name
   * @returns {Numbers | null} `null` for a sense that is off and for names that do not exist
   */
  view(name) {
    const buffer = /** @type {WebAssembly.Memory} */ (module.memory).buffer;
    const known = this.#views.get(name);
    if (known && known.buffer === buffer) return known;
    const view = this.#place(name, buffer);
    if (view) this.#views.set(name, view);
    return view;
  }

  /**
   * @param {string} name
   * @param {ArrayBuffer} buffer
   */
  #place(name, buffer) {
    const place = guarded(() => this.#core.view(name));
    if (!place) return null;
    const [kind, at, length] = place;
    return new KINDS[/** @type {1 | 4 | 5 | 8} */ (kind)](buffer, at, length);
  }

  /** What the last step reports. */
  get info() {
    return /** @type {import("./types.js").Info} */ (guarded(() => this.#core.info()));
  }

  /** The simulated time, s. */
  get time() {
    return guarded(() => this.#core.time());
  }

  /**
   * Brings what is drawn up to date, as at the start of the last physics step.
   * @returns {import("./types.js").Frame}
   */
  update() {
    guarded(() => this.#core.update());
    const { buffer } = /** @type {WebAssembly.Memory} */ (module.memory);
    const view = (/** @type {string} */ name) => /** @type {Float32Array} */ (this.#place(name, buffer));
    return { poses: view("poses"), bodies: view("bodies"), felt: view("felt"), contacts: view("contacts") };
  }

  /** Bodies, joints, geoms, cameras and actions. */
  get model() {
    return (this.#model ??= /** @type {import("./types.js").Model} */ (guarded(() => this.#core.model())));
  }

  /** Shapes, colours, textures and lights. */
  get look() {
    return (this.#look ??= /** @type {import("./types.js").Look} */ (guarded(() => this.#core.look())));
  }

  /**
   * Copies an image of a texture: red, green, blue and 255 for each pixel, rows from the top.
   * @param {number} texture
   * @param {number} [face] of a cube
   */
  texturePixels(texture, face = 0) {
    const place = guarded(() => this.#core.texturePixels(texture, face));
    if (!place) throw new Error(`there is no face ${face} of a texture ${texture}`);
    return new Uint8Array(/** @type {WebAssembly.Memory} */ (module.memory).buffer, place[1], place[2]).slice();
  }

  /** Where the touch sensors are: three numbers each in the frame of their body, m; the body; values for each sensor. */
  get skin() {
    const core = this.#core;
    return guarded(() => ({ positions: core.skinPositions(), bodies: core.skinBodies(), width: core.touchWidth() }));
  }

  /**
   * Names the numbers of proprioception, in order.
   * @returns {{ component: string, name: string, start: number, end: number }[]}
   */
  get proprioceptionNames() {
    return guarded(() => this.#core.proprioceptionNames());
  }

  /**
   * Locks a joint, such as `robot:right_elbow`, or all joints of a part, such as `hands`, at an angle.
   * @param {string} target
   * @param {number} [angle] rad
   * @returns {import("./types.js").LockReport}
   */
  lock(target, angle = 0) {
    return guarded(() => this.#core.lock(target, angle));
  }

  /**
   * Unlocks a joint, or all joints of a part.
   * @param {string} target
   * @returns {import("./types.js").LockReport}
   */
  unlock(target) {
    return guarded(() => this.#core.unlock(target));
  }

  /** The locked joints, by number. */
  get locked() {
    return guarded(() => this.#core.locked());
  }

  /** Takes a snapshot: all that decides how the run goes on, random numbers, locks and applied forces included. */
  snapshot() {
    return guarded(() => this.#core.snapshot());
  }

  /**
   * Goes back to a snapshot; the run continues with the same bits. Poses and contacts are brought up to date at once, the
   * observation of touch and of the eyes by the next step.
   * @param {Uint8Array} bytes
   */
  restore(bytes) {
    guarded(() => this.#core.restore(bytes));
    this.#views.clear();
  }

  /**
   * Adds a force (N) and a torque (N m) at a point (m), in the world, to what acts on a body. They act in every step until
   * {@link Env.releaseForces} or the next reset.
   * @param {number} body
   * @param {ArrayLike<number>} force
   * @param {ArrayLike<number>} [torque]
   * @param {ArrayLike<number>} [point] by default the centre of mass
   */
  applyForce(body, force, torque = [0, 0, 0], point) {
    const centre = () => /** @type {Float64Array} */ (this.view("xipos")).slice(3 * body, 3 * body + 3);
    const at = point ? Float64Array.from(point) : centre();
    guarded(() => this.#core.applyForce(body, Float64Array.from(force), Float64Array.from(torque), at));
  }

  /** Takes off all forces on bodies. */
  releaseForces() {
    guarded(() => this.#core.releaseForces());
  }

  /**
   * Draws the scene from one of its cameras, by name, or from anywhere. The pixels are a view, ready for `ImageData`: red,
   * green, blue and 255, rows from the top, until the next picture.
   * @param {string | import("./types.js").FreeCamera} camera
   * @param {number} width
   * @param {number} height
   */
  draw(camera, width, height) {
    const named = typeof camera === "string";
    const free = named ? undefined : [...camera.lookat, camera.distance, camera.azimuth, camera.elevation];
    const [at, length] = guarded(() => this.#core.draw(named ? camera : "", free && Float64Array.from(free), width, height));
    return new Uint8ClampedArray(/** @type {WebAssembly.Memory} */ (module.memory).buffer, at, length);
  }

  /**
   * Sets whether resets and steps leave the eyes' pictures as they are, for {@link Env.drawEyes} to draw.
   * @param {boolean} deferred
   */
  deferVision(deferred) {
    guarded(() => this.#core.deferVision(deferred));
  }

  /**
   * Draws what both eyes see at this moment, with the acuity and the foveation of the configuration, and leaves the observation, to which
   * noise and delay belong, as it is. Returns a view of the left and then the right picture, `vision_resolution` pixels wide and
   * high, as {@link Env.draw} does.
   */
  lookThroughEyes() {
    const [at, length] = guarded(() => this.#core.lookThroughEyes());
    return new Uint8ClampedArray(/** @type {WebAssembly.Memory} */ (module.memory).buffer, at, length);
  }

  /** Draws what the eyes see into the observation. */
  drawEyes() {
    guarded(() => this.#core.drawEyes());
    return this.observation;
  }

  /** Returns the checksum of positions, velocities and senses that `examples/checksum` prints. */
  checksum() {
    return guarded(() => this.#core.checksum());
  }

  /** Frees the memory. Without it, it is freed some time after the last use. */
  free() {
    this.#core.free();
    this.#views.clear();
  }
}
