// The environment as the page uses it: the package's environment, with the data arranged for a page.
import init, { Blueprint, Env, configKeys, loadFace, memoryBytes } from "babybench/babybench.js";
import { Glances } from "./glances.js";

/** @typedef {import("../types").Settings} Settings */

/** Parts of the body that a palm can touch: what the score of self-touch counts. */
const PARTS = 34;

/** Loads the module. */
export const load = () => init();

/**
 * Fetches the face that the settings select, which an environment needs before it is made.
 * @param {Settings | string} settings
 * @param {Record<string, Uint8Array>} [assets]
 */
export async function fetchFace(settings, assets) {
  const name = (typeof settings === "string" ? read(settings, assets) : settings).facial_expression;
  // what is not a face is refused with the settings, by their key
  if (configKeys().some((key) => key.name === "facial_expression" && key.options?.includes(String(name)))) await loadFace(String(name));
}

/**
 * Reads the text of a file.
 * @param {string} text
 * @param {Record<string, Uint8Array>} [assets]
 */
function read(text, assets) {
  const blueprint = new Blueprint(text, "configuration", assets);
  const { config } = blueprint;
  blueprint.free();
  return config;
}

export class PageEnv {
  /**
   * @param {Settings | string} settings values by key, or the text of a file
   * @param {Record<string, Uint8Array>} [assets] files of a custom room
   */
  constructor(settings, assets) {
    this.env = new Env(settings, "configuration", assets);
    this.assets = assets;
    const { env } = this;
    env.deferVision(true);
    this.yaml = env.yaml;
    /** @type {Settings} */
    this.settings = { ...env.config };
    this.model = env.model;
    const fixed = fixedBodies(this.model);
    this.actions = this.model.actions;
    this.bodies = this.model.bodies.map((b, i) => ({ name: b.name, parent: b.parent, mass: b.mass, invweight: b.invweight0[0], movable: !fixed.has(i) }));
    this.joints = this.model.joints.map((j) => ({ name: j.name, part: j.part, qpos: j.qposadr, dof: j.dofadr, low: j.range?.[0] ?? -Math.PI, high: j.range?.[1] ?? Math.PI }));
    this.look = env.look;
    this.skin = { at: env.skin.positions.slice(), of: Uint16Array.from(env.skin.bodies) };
    const worn = this.look.drawables.reduce((sum, d) => sum + (d.worn && d.mesh ? 2 * d.mesh.position.length : 0), 0);
    this.count = { worn, drawables: this.look.drawables.length, bodies: this.bodies.length, sensors: this.skin.of.length, actions: this.actions.length, joints: this.joints.length };
    this.seconds = this.model.timestep * this.model.frame_skip;
    this.glances = new Glances(this.seconds * env.visionDelay);
    this.steps = 0;
    this.ownLocks = this.locked().join();
  }

  free() {
    this.env.free();
  }

  get time() {
    return this.env.time;
  }

  get memory() {
    return memoryBytes();
  }

  /**
   * A vector of the state, by MuJoCo's name: a view that the next call may change.
   * @param {string} name
   */
  state(name) {
    return /** @type {Float64Array} */ (this.env.view(name));
  }

  /** @param {number} seed */
  reset(seed) {
    this.env.reset(seed);
    this.steps = 0;
  }

  /** @param {{ qpos0: Float64Array, qvel0: Float64Array, activity0: Float64Array }} start */
  resetTo(start) {
    this.env.resetTo(start.qpos0, start.qvel0);
    const muscles = this.state("act").length;
    this.env.setActivity(start.activity0.length ? start.activity0 : new Float64Array(muscles));
    this.steps = 0;
  }

  /** The start of a recording. */
  start() {
    return { qpos0: this.state("qpos").slice(), qvel0: this.state("qvel").slice(), activity0: this.state("act").slice() };
  }

  qpos() {
    return this.state("qpos").slice();
  }

  /**
   * @param {Float32Array} action
   * @returns {boolean} whether the episode is over
   */
  step(action) {
    this.steps++;
    const { terminated, truncated } = this.env.step(action);
    return terminated || truncated;
  }

  /** @param {Float32Array} action */
  sampleAction(action) {
    action.set(this.env.sampleAction());
  }

  clearForces() {
    this.env.releaseForces();
  }

  /**
   * @param {number} body
   * @param {[number, number, number]} force
   * @param {[number, number, number]} at
   */
  pull(body, force, at) {
    this.env.applyForce(body, force, [0, 0, 0], at);
  }

  /** Updates the drawn numbers; they are valid until the next call. */
  refresh() {
    return this.env.update();
  }

  /** @returns {ArrayLike<number>} acceleration and rotation of the head, zeros without that sense */
  balance() {
    return this.env.observation.vestibular ?? new Float64Array(6);
  }

  /**
   * Position and quaternion of a body in double precision, as they are at the next step.
   * @param {number} body
   * @returns {number[]}
   */
  pose(body) {
    const [at, turn] = [this.state("xpos"), this.state("xquat")];
    return [...at.subarray(3 * body, 3 * body + 3), ...turn.subarray(4 * body, 4 * body + 4)];
  }

  /**
   * @param {Float32Array} angles
   * @param {Float32Array} torques
   */
  readJoints(angles, torques) {
    const [qpos, force] = [this.state("qpos"), this.state("qfrc_actuator")];
    this.joints.forEach((j, i) => {
      angles[i] = qpos[j.qpos];
      torques[i] = force[j.dof];
    });
  }

  /** @returns {import("../types").Score} */
  score() {
    const { behavior, score, touched_parts, page_regards, kit_regards, is_success, is_failure, return: earned } = this.env.info;
    return {
      behavior,
      value: score,
      steps: this.steps,
      success: is_success,
      failure: is_failure,
      earned,
      hands: touched_parts && { right: touched_parts.right_hand, left: touched_parts.left_hand, reachable: PARTS },
      regards: /** @type {import("../types").Score["regards"]} */ (page_regards),
      kit: /** @type {import("../types").Score["kit"]} */ (kit_regards),
    };
  }

  /**
   * The pictures that the eyes report, with the sharpness and the delay of the configuration.
   * @returns {import("../types").Glance}
   */
  eyes() {
    return { sizes: this.env.eyeSizes, ...this.glances.take(this.time, this.env.lookThroughEyes().slice()) };
  }

  /** @returns {boolean[]} of all joints */
  locked() {
    const on = new Set(this.env.locked);
    return this.joints.map((_, i) => on.has(i));
  }

  /** Whether locks were set or removed since the environment was made. */
  get locksDiffer() {
    return this.locked().join() !== this.ownLocks;
  }

  /**
   * Locks a joint, or all joints of a part, where they are; or unlocks them.
   * @param {string} target
   * @param {boolean} on
   */
  lock(target, on) {
    const qpos = this.qpos();
    for (const j of this.joints) {
      if (j.part === null || (j.name !== target && j.part !== target)) continue;
      if (on) this.env.lock(j.name, qpos[j.qpos]);
      else this.env.unlock(j.name);
    }
    return this.locked();
  }

  /** @param {string} name of the face that he makes from now on */
  async face(name) {
    await loadFace(name);
    this.env.swapFacialExpression(name);
    this.settings = { ...this.env.config };
    this.yaml = this.env.yaml;
    this.look = this.env.look;
    return this.scene();
  }

  snapshot() {
    return this.env.snapshot();
  }

  /** @param {Uint8Array} bytes */
  restore(bytes) {
    this.env.restore(bytes);
    this.steps = this.env.info.steps;
  }

  checksum() {
    return this.env.checksum();
  }

  /** The data that the page gets once. */
  scene() {
    const locked = this.locked();
    const defaults = new Map(PageEnv.keys().map((k) => [k.name, k.default]));
    return {
      settings: this.settings,
      // the defaults of tasks differ from those of the table
      changed: this.env.info.is_success === null ? Object.fromEntries(Object.entries(this.settings).filter(([name, value]) => String(value) !== String(defaults.get(name)))) : this.settings,
      yaml: this.yaml,
      drawables: this.look.drawables.map(({ texture_scale, texture_offset, ...d }) => ({ ...d, textureScale: texture_scale, textureOffset: texture_offset })),
      textures: this.look.textures.map((faces, t) => faces.map(({ width, height }, f) => ({ width, height, pixels: this.env.texturePixels(t, f) }))),
      bodies: this.bodies,
      joints: this.joints.map((j, i) => ({ ...j, locked: locked[i] })),
      actions: this.actions,
      cameras: this.model.cameras.map((c) => c.name),
      skin: this.skin,
      timestep: this.seconds,
    };
  }

  /** @returns {import("../types").Key[]} the table of configuration keys */
  static keys() {
    return configKeys();
  }
}

/**
 * The bodies that no joint moves.
 * @param {{ bodies: { parent: number }[], joints: { body: number }[] }} model
 * @returns {Set<number>}
 */
function fixedBodies(model) {
  const jointed = new Set(model.joints.map((j) => j.body));
  const fixed = new Set([0]);
  model.bodies.forEach((b, i) => {
    if (i > 0 && !jointed.has(i) && fixed.has(b.parent)) fixed.add(i);
  });
  return fixed;
}
