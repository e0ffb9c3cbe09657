/// <reference lib="esnext.disposable" preserve="true" />
// ONNX policies, in a module of their own that is loaded on demand.
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
 * A policy from an ONNX model. Its inputs are named after entries of the observation (`observation`, `touch`, `vestibular`, `eye_left`,
 * `eye_left_depth`, ...: the keys of {@link Env.observationSpace}), or a single input takes all of them. Its output is the action.
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
  /** Properties of the observation. */
  #names;

  /**
   * Reads a model for an environment and for others with the same observations and actions.
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
    const spaces = env.observationSpace;
    // refused objects are freed by the garbage collector
    guarded(() => {
      for (const { name, shape } of spaces) model.sense(name, Uint32Array.from(shape));
      model.connect();
    });
    this.#names = spaces.map((space) => space.name);
    this.#model = model;
  }

  /**
   * Returns the action for what an environment senses, clipped to the action space.
   * @param {import("./env.js").Env} env
   * @returns {Float32Array}
   */
  act(env) {
    if (!(env instanceof Env)) refuse("env", env, "an Env");
    const [model, { observation }] = [this.#live(), env];
    const observed = this.#names.map((name) => observation[name]);
    const missing = this.#names.filter((_, k) => !observed[k]);
    if (missing.length > 0) refuse("env", env, `an Env that observes ${missing.join(", ")}`);
    return guarded(() => model.act(observed));
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
