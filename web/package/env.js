/// <reference lib="esnext.disposable" preserve="true" />
// One environment.
import { Blueprint } from "./blueprint.js";
import * as check from "./check.js";
import { ArgumentError, FreedError } from "./errors.js";
import { checkFace } from "./faces.js";
import { guarded, memory } from "./module.js";

/** @typedef {import("./types.js").Observation} Observation */
/** @typedef {Float32Array | Float64Array | Int32Array | Uint8Array} Numbers */

const KINDS = /** @type {const} */ ({ 1: Uint8Array, 4: Float32Array, 5: Int32Array, 8: Float64Array });

/**
 * An environment. Numbers are views on the module's memory, without copies: they change with the next step, and a view that
 * you keep has length 0 once that memory has grown, for example by a reset, a first picture or another environment. Read them again from
 * {@link Env.observation}, {@link Env.action} or {@link Env.view}, or copy them with `slice()`.
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
  /** @type {import("./core.js").Core | undefined} */
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
   * @param {import("./types.js").Assets} [assets] files by path, with a custom scene and its textures
   */
  constructor(config = {}, name, assets) {
    const shared = config instanceof Blueprint;
    const blueprint = shared ? config : new Blueprint(config, name, assets);
    const core = guarded(() => blueprint.core.env());
    this.#core = core;
    this.#config = blueprint.config;
    this.#yaml = blueprint.yaml;
    // after a trap nothing can be freed; refused objects are freed by the garbage collector
    if (!shared) blueprint.free();
    const env = this;
    const names = guarded(() => core.observationNames());
    const getters = names.map((name) => [name, { enumerable: true, get: () => env.view(name) }]);
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
    const from = seed === undefined ? undefined : check.seed("seed", seed);
    this.#call((core) => core.reset(from));
    return this.observation;
  }

  /**
   * Starts an episode from positions (nq) and velocities (nv).
   * @param {ArrayLike<number>} qpos
   * @param {ArrayLike<number>} qvel
   */
  resetTo(qpos, qvel) {
    const [positions, velocities] = [check.numbers("qpos", qpos, this.model.nq), check.numbers("qvel", qvel, this.model.nv)];
    this.#call((core) => core.resetTo(positions, velocities));
    return this.observation;
  }

  /**
   * Sets positions and velocities in the middle of an episode.
   * @param {ArrayLike<number>} qpos
   * @param {ArrayLike<number>} qvel
   */
  setState(qpos, qvel) {
    const [positions, velocities] = [check.numbers("qpos", qpos, this.model.nq), check.numbers("qvel", qvel, this.model.nv)];
    this.#call((core) => core.setState(positions, velocities));
    return this.observation;
  }

  /**
   * Sets the activations of the muscles.
   * @param {ArrayLike<number>} activity
   */
  setActivity(activity) {
    const values = check.numbers("activity", activity, this.view("act")?.length);
    this.#call((core) => core.setActivity(values));
  }

  /**
   * Steps with an action; without one, with the contents of {@link Env.action}.
   * @param {ArrayLike<number>} [action]
   * @returns {import("./types.js").Step}
   */
  step(action) {
    const own = this.action;
    if (action !== undefined && action !== own) own.set(check.numbers("action", action, own.length));
    const env = this;
    return this.#call((core) => (core.step(), {
      observation: this.observation,
      reward: core.reward(),
      terminated: core.terminated(),
      truncated: core.truncated(),
      get info() {
        return env.info; // made when it is read: most steps need none
      },
    }));
  }

  /**
   * Changes the desired goal of this episode.
   * @param {ArrayLike<number>} desired
   */
  setGoal(desired) {
    const goal = check.numbers("desired", desired, this.view("desired_goal")?.length);
    this.#call((core) => core.setGoal(goal));
    return this.observation;
  }

  /**
   * Computes the rewards for rows of goals. For the goals of a step, the result is the reward of that step.
   * @param {ArrayLike<number>[]} achieved
   * @param {ArrayLike<number>[]} desired
   * @param {{ reward_terms: number[] | null }[]} infos those of the steps
   * @returns {Float64Array} a reward for each row
   */
  computeReward(achieved, desired, infos) {
    const [reached, wanted] = [check.rows("achieved", achieved), check.rows("desired", desired)];
    for (const [name, list] of /** @type {const} */ ([["desired", desired], ["infos", infos]])) {
      if (!Array.isArray(list) || list.length !== achieved.length) check.refuse(name, list, `an array of ${achieved.length}, as \`achieved\``);
    }
    const terms = check.rows("infos", infos.map((info, i) => (info?.reward_terms === undefined ? check.refuse(`infos[${i}]`, info, "the info of a step") : (info.reward_terms ?? []))));
    return this.#call((core) => core.computeReward(reached, wanted, terms, achieved.length));
  }

  /** The next action, to write into. */
  get action() {
    return /** @type {Float32Array} */ (this.view("action"));
  }

  /** Fills {@link Env.action} with a random action, the one that Gymnasium draws from the same seed, and returns it. */
  sampleAction() {
    this.#call((core) => core.sampleAction());
    return this.action;
  }

  /**
   * Seeds the random actions.
   * @param {number | bigint} seed
   */
  seedActionSpace(seed) {
    const from = check.seed("seed", seed);
    this.#call((core) => core.seedActionSpace(from));
  }

  /** The observation of the last reset or step. Its views are created when read, so they are always valid. */
  get observation() {
    return this.#observation;
  }

  /**
   * Returns a view of numbers by name: of the observation, or of the state by MuJoCo's names (`qpos`, `xpos`,
   * `geom_xmat`, `actuator_force` ...). It is valid until the module's memory grows, which empties it, or a snapshot is restored.
   * @param {string} name
   * @returns {Numbers | null} `null` for a sense that is off and for names that do not exist
   */
  view(name) {
    check.text("name", name);
    const buffer = memory();
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
    const place = this.#call((core) => core.view(name));
    if (!place) return null;
    const [kind, at, length] = place;
    return new KINDS[/** @type {1 | 4 | 5 | 8} */ (kind)](buffer, at, length);
  }

  /** The information of the last step. */
  get info() {
    return /** @type {import("./types.js").Info} */ (this.#call((core) => core.info()));
  }

  /** The simulated time, s. */
  get time() {
    return this.#call((core) => core.time());
  }

  /**
   * Updates the drawn scene to the start of the last physics step.
   * @returns {import("./types.js").Frame}
   */
  update() {
    this.#call((core) => core.update());
    const buffer = memory();
    const view = (/** @type {string} */ name) => /** @type {Float32Array} */ (this.#place(name, buffer));
    return { poses: view("poses"), bodies: view("bodies"), felt: view("felt"), contacts: view("contacts"), worn: view("worn") };
  }

  /** Bodies, joints, geoms, cameras and actions. */
  get model() {
    return (this.#model ??= /** @type {import("./types.js").Model} */ (this.#call((core) => core.model())));
  }

  /** Shapes, colours, textures and lights. */
  get look() {
    return (this.#look ??= /** @type {import("./types.js").Look} */ (this.#call((core) => core.look())));
  }

  /**
   * Copies an image of a texture: red, green, blue and 255 for each pixel, rows from the top.
   * @param {number} texture
   * @param {number} [face] of a cube
   */
  texturePixels(texture, face = 0) {
    const [which, side] = [check.whole("texture", texture), check.whole("face", face)];
    const place = this.#call((core) => core.texturePixels(which, side));
    if (!place) throw new ArgumentError("texture", `there is no face ${face} of a texture ${texture}`);
    return new Uint8Array(memory(), place[1], place[2]).slice();
  }

  /** The touch sensors: position, three numbers each in the frame of their body, m; the body; values for each sensor. */
  get skin() {
    return this.#call((core) => ({ positions: core.skinPositions(), bodies: core.skinBodies(), width: core.touchWidth() }));
  }

  /**
   * Describes the observation: each entry's property of {@link Env.observation}, Gymnasium's key, shape, number type and bounds.
   * @returns {import("./types.js").ObservationSpace[]}
   */
  get observationSpace() {
    return this.#call((core) => core.observationSpace());
  }

  /** The time between two steps, s. */
  get dt() {
    return this.#call((core) => core.dt());
  }

  /**
   * Names the numbers of proprioception, in order.
   * @returns {{ component: string, name: string, start: number, end: number }[]}
   */
  get proprioceptionNames() {
    return this.#call((core) => core.proprioceptionNames());
  }

  /**
   * Locks a joint, such as `robot:right_elbow`, or all joints of a part, such as `hands`, at an angle.
   * @param {string} target
   * @param {number} [angle] rad
   * @returns {import("./types.js").LockReport}
   */
  lock(target, angle = 0) {
    const [which, at] = [check.text("target", target), check.finite("angle", angle)];
    return this.#call((core) => core.lock(which, at));
  }

  /**
   * Unlocks a joint, or all joints of a part.
   * @param {string} target
   * @returns {import("./types.js").LockReport}
   */
  unlock(target) {
    check.text("target", target);
    return this.#call((core) => core.unlock(target));
  }

  /**
   * Changes MIMo's face at any time. Only pictures change. Fetch all but the default one with {@link loadFace} first.
   * @param {string} expression such as `happy`
   */
  swapFacialExpression(expression) {
    checkFace("expression", expression);
    this.#yaml = this.#call((core) => core.swapFacialExpression(expression));
    this.#config = { ...this.#config, facial_expression: expression };
    this.#look = undefined;
    this.#views.clear();
    return this.observation;
  }

  /** The locked joints, by number. */
  get locked() {
    return this.#call((core) => core.locked());
  }

  /**
   * Width and height of the left eye's pictures, then of the right one's, pixels.
   * @returns {[[number, number], [number, number]]}
   */
  get eyeSizes() {
    const [width, height, ...right] = this.#call((core) => core.eyeSizes());
    return [[width, height], [right[0], right[1]]];
  }

  /** The delay of vision, in steps. */
  get visionDelay() {
    return this.#call((core) => core.visionDelay());
  }

  /** Takes a snapshot: everything that decides how the run continues, including random numbers, locks and applied forces. */
  snapshot() {
    return this.#call((core) => core.snapshot());
  }

  /**
   * Goes back to a snapshot; the run continues with the same bits. Poses and contacts are brought up to date at once, the
   * observation of touch and of the eyes by the next step.
   * @param {Uint8Array} bytes
   */
  restore(bytes) {
    check.bytes("bytes", bytes);
    this.#call((core) => core.restore(bytes));
    this.#views.clear();
  }

  /**
   * Adds a force (N) and a torque (N m) at a point (m), in the world, to those on a body. They act in every step until
   * {@link Env.releaseForces} or the next reset.
   * @param {number} body
   * @param {ArrayLike<number>} force
   * @param {ArrayLike<number>} [torque]
   * @param {ArrayLike<number>} [point] by default the centre of mass
   */
  applyForce(body, force, torque = [0, 0, 0], point) {
    const centres = /** @type {Float64Array} */ (this.view("xipos"));
    check.whole("body", body, 0, centres.length / 3 - 1);
    const at = point === undefined ? centres.slice(3 * body, 3 * body + 3) : check.numbers("point", point, 3);
    const [push, turn] = [check.numbers("force", force, 3), check.numbers("torque", torque, 3)];
    this.#call((core) => core.applyForce(body, push, turn, at));
  }

  /** Removes all applied forces. */
  releaseForces() {
    this.#call((core) => core.releaseForces());
  }

  /**
   * Draws the scene from one of its cameras, by name, or from anywhere. The pixels are a view, ready for `ImageData`: red,
   * green, blue and 255, rows from the top, until the next picture. Memory may grow for it, which empties earlier views.
   * @param {string | import("./types.js").FreeCamera} camera
   * @param {number} width
   * @param {number} height
   */
  draw(camera, width, height) {
    const named = typeof camera === "string";
    const free = named ? undefined : check.camera("camera", camera);
    const [w, h] = [check.whole("width", width, 1), check.whole("height", height, 1)];
    const [at, length] = this.#call((core) => core.draw(named ? camera : "", free, w, h));
    return new Uint8ClampedArray(memory(), at, length);
  }

  /**
   * Sets whether resets and steps skip the eyes' pictures, which {@link Env.drawEyes} then draws.
   * @param {boolean} deferred
   */
  deferVision(deferred) {
    check.flag("deferred", deferred);
    this.#call((core) => core.deferVision(deferred));
  }

  /**
   * Draws the current view of both eyes, with the acuity and the foveation of the configuration. The observation, with its
   * noise and delay, does not change. Returns a view of the left and then the right picture, of the sizes {@link Env.eyeSizes}, as
   * {@link Env.draw} does.
   */
  lookThroughEyes() {
    const [at, length] = this.#call((core) => core.lookThroughEyes());
    return new Uint8ClampedArray(memory(), at, length);
  }

  /** Draws what the eyes see into the observation. */
  drawEyes() {
    this.#call((core) => core.drawEyes());
    return this.observation;
  }

  /** Returns the checksum of positions, velocities and senses that `examples/checksum` prints. */
  checksum() {
    return this.#call((core) => core.checksum());
  }

  /** Frees the memory. Without it, it is freed some time after the last use. A second call throws a `FreedError`. */
  free() {
    this.#call((core) => {
      this.#core = undefined;
      core.free();
    });
    this.#views.clear();
  }

  /** Frees the memory at the end of a block with `using`, unless it was freed before. */
  [Symbol.dispose]() {
    if (this.#core) this.free();
  }

  /**
   * Calls into the module.
   * @template T
   * @param {(core: import("./core.js").Core) => T} call
   * @returns {T}
   */
  #call(call) {
    const core = this.#core;
    if (!core) throw new FreedError("environment");
    return guarded(() => call(core));
  }
}
