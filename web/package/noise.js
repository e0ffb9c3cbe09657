/// <reference lib="esnext.disposable" preserve="true" />
// Random movements, with which infants babble and learners explore.
import { refuse, seed as seedOf, text } from "./check.js";
import { ActionNoise as CoreNoise } from "./core.js";
import { Env } from "./env.js";
import { ArgumentError, FreedError, ModuleError } from "./errors.js";
import { guarded, memory } from "./module.js";

/**
 * Action noise for an environment: the same seed gives the same actions here, in Rust and in Python.
 *
 * ```js
 * const noise = new ActionNoise("pink", env, 42);
 * env.step(noise.sample());
 * ```
 */
export class ActionNoise {
  /** @type {CoreNoise | undefined} */
  #core;

  /**
   * @param {string} noise `white` (new at every step), `held` (for 0.5 s; `held:0.1` for 0.1 s), `ou` (Ornstein-Uhlenbeck; `ou:0.2` with a
   * correlation of 0.2 s), `pink`, `color:0.69` (power falls with that power of the frequency, 0 to 2), `color_by_age:3` (the exponent of
   * infants of 3 months), or `oscillators` (coupled, of 1 Hz; `oscillators:2` of 2 Hz)
   * @param {Env} env the environment to act in
   * @param {number | bigint} [seed]
   */
  constructor(noise, env, seed = 0) {
    const [name, from] = [text("noise", noise), seedOf("seed", seed)];
    if (!(env instanceof Env)) refuse("env", env, "an Env");
    memory();
    const { actions } = env.model;
    const bounds = (/** @type {"low" | "high"} */ side) => Float32Array.from(actions, (a) => a[side]);
    try {
      this.#core = guarded(() => new CoreNoise(name, bounds("low"), bounds("high"), env.dt, from));
    } catch (error) {
      if (error instanceof ModuleError || !(error instanceof Error)) throw error;
      throw new ArgumentError("noise", error.message);
    }
  }

  /** Returns the next action. */
  sample() {
    return guarded(() => this.#live().sample());
  }

  /**
   * Restarts.
   * @param {number | bigint} [seed]
   */
  reset(seed = 0) {
    const [core, from] = [this.#live(), seedOf("seed", seed)];
    guarded(() => core.reset(from));
  }

  /** Frees the memory. Without it, it is freed some time after the last use. A second call throws a `FreedError`. */
  free() {
    const core = this.#live();
    this.#core = undefined;
    guarded(() => core.free());
  }

  /** Frees the memory at the end of a block with `using`, unless it was freed before. */
  [Symbol.dispose]() {
    if (this.#core) this.free();
  }

  #live() {
    if (!this.#core) throw new FreedError("noise");
    return this.#core;
  }
}
