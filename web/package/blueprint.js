// What environments of one configuration share.
import { Blueprint as CoreBlueprint } from "./core.js";
import { Env } from "./env.js";
import { guarded } from "./errors.js";
import { module } from "./module.js";
import { yamlOf } from "./yaml.js";

/** What all environments of one configuration share: environments from it are cheap. */
export class Blueprint {
  #core;

  /**
   * Builds the scene.
   * @param {import("./types.js").Settings | string} [config] values by key, or the text of a YAML file
   * @param {string} [name] of the file, for errors
   */
  constructor(config = {}, name = "configuration") {
    if (!module.memory) throw new Error("the module is not loaded: `await init()` first");
    this.#core = guarded(() => new CoreBlueprint(yamlOf(config), name));
  }

  /** Makes an environment. */
  env() {
    return new Env(this);
  }

  /** The complete configuration, as the text of a YAML file. */
  get yaml() {
    return guarded(() => this.#core.toYaml());
  }

  /**
   * The complete configuration by key.
   * @returns {import("./types.js").Config}
   */
  get config() {
    return Object.fromEntries(guarded(() => this.#core.config()));
  }

  /** Frees the memory. Environments made from it stay. */
  free() {
    this.#core.free();
  }

  /** @internal */
  get core() {
    return this.#core;
  }
}
