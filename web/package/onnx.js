// ONNX policies, in a module of its own that is loaded when it is wanted.
import start, { Model } from "./onnx_core.js";
import { guarded } from "./errors.js";
import { locate, once } from "./load.js";

/**
 * Loads the module, once, before the first {@link OnnxPolicy}. Without a source it is the file `onnx_core_bg.wasm` beside
 * this one.
 * @type {(source?: import("./load.js").Source) => Promise<void>}
 */
const init = once(async (source) => {
  const bytes = await locate(source, new URL("onnx_core_bg.wasm", import.meta.url));
  await start({ module_or_path: bytes });
});
export default init;

/**
 * A policy that is an ONNX model. Its inputs are named after the senses it uses (`observation`, `touch`, `vestibular`,
 * `eye_left`, `eye_right`), or it has a single one for all of them; its output is the action.
 *
 * ```js
 * import init, { OnnxPolicy } from "babybench/onnx";
 * await init();
 * const policy = new OnnxPolicy(bytes, env);
 * env.step(policy.act(env));
 * ```
 */
export class OnnxPolicy {
  #model;

  /**
   * Reads a model for an environment, and for those that sense and act alike.
   * @param {Uint8Array} bytes
   * @param {import("./env.js").Env} env
   * @param {string} [name] of the file, for errors
   */
  constructor(bytes, env, name = "model") {
    const { actions } = env.model;
    const bounds = (/** @type {"low" | "high"} */ side) => Float32Array.from(actions, (a) => a[side]);
    this.#model = guarded(() => new Model(bytes, name, bounds("low"), bounds("high")));
    const { observation: seen } = env;
    const eye = (/** @type {Uint8Array | null} */ pixels) => pixels && [Math.sqrt(pixels.length / 3), Math.sqrt(pixels.length / 3), 3];
    const vector = (/** @type {ArrayLike<number> | null} */ values) => values && [values.length];
    const senses = /** @type {const} */ ([
      ["observation", vector(seen.proprioception)],
      ["touch", vector(seen.touch)],
      ["eye_left", eye(seen.eye_left)],
      ["eye_right", eye(seen.eye_right)],
      ["vestibular", vector(seen.vestibular)],
    ]);
    try {
      for (const [key, shape] of senses) if (shape) this.#model.sense(key, Uint32Array.from(shape));
      this.#model.connect();
    } catch (error) {
      this.#model.free();
      throw error;
    }
  }

  /**
   * Returns the action for what an environment senses, clipped to the action space.
   * @param {import("./env.js").Env} env
   * @returns {Float32Array}
   */
  act(env) {
    const o = env.observation;
    return guarded(() => this.#model.act(o.proprioception, o.touch, o.vestibular, o.eye_left, o.eye_right));
  }

  /** Frees the memory. Without it, it is freed some time after the last use. */
  free() {
    this.#model.free();
  }
}
