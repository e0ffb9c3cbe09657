/// <reference lib="esnext.disposable" preserve="true" />
// ONNX policies, in a module of its own that is loaded when it is wanted.
import start, { Model } from "./onnx_core.js";
import { bytes as bytesOf, refuse, text } from "./check.js";
import { Env } from "./env.js";
import { FreedError, guard, MissingError } from "./errors.js";
import { locate, once } from "./load.js";

const guarded = guard();
let loaded = false;

/**
 * Loads the module, once, before the first {@link OnnxPolicy}. Without a source it is the file `onnx_core_bg.wasm` beside
 * this one.
 * @type {(source?: import("./load.js").Source) => Promise<void>}
 */
const init = once(async (source) => {
  const bytes = await locate(source, new URL("onnx_core_bg.wasm", import.meta.url));
  await start({ module_or_path: bytes });
  loaded = true;
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
  /** @type {Model | undefined} */
  #model;

  /**
   * Reads a model for an environment, and for those that sense and act alike.
   * @param {Uint8Array} bytes
   * @param {import("./env.js").Env} env
   * @param {string} [name] of the file, for errors
   */
  constructor(bytes, env, name = "model") {
    bytesOf("bytes", bytes);
    if (!(env instanceof Env)) refuse("env", env, "an Env");
    text("name", name);
    if (!loaded) throw new MissingError("the module is not loaded: `await init()` of babybench/onnx first");
    const { actions } = env.model;
    const bounds = (/** @type {"low" | "high"} */ side) => Float32Array.from(actions, (a) => a[side]);
    const model = guarded(() => new Model(bytes, name, bounds("low"), bounds("high")));
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
    // what was refused is freed when nobody holds it
    guarded(() => {
      for (const [key, shape] of senses) if (shape) model.sense(key, Uint32Array.from(shape));
      model.connect();
    });
    this.#model = model;
  }

  /**
   * Returns the action for what an environment senses, clipped to the action space.
   * @param {import("./env.js").Env} env
   * @returns {Float32Array}
   */
  act(env) {
    if (!(env instanceof Env)) refuse("env", env, "an Env");
    const [model, o] = [this.#live(), env.observation];
    const senses = /** @type {const} */ ([o.proprioception, o.touch, o.vestibular, o.eye_left, o.eye_right]);
    return guarded(() => model.act(...senses));
  }

  /** Frees the memory. Without it, it is freed some time after the last use. A second call throws a `FreedError`. */
  free() {
    const model = this.#live();
    this.#model = undefined;
    guarded(() => model.free());
  }

  /** Frees the memory at the end of a block with `using`, unless it was freed before. */
  [Symbol.dispose]() {
    if (this.#model) this.free();
  }

  #live() {
    if (!this.#model) throw new FreedError("policy");
    return this.#model;
  }
}
