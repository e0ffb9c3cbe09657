/// <reference lib="esnext.disposable" preserve="true" />
// The part that environments of one configuration share.
import { files, text } from "./check.js";
import { Blueprint as CoreBlueprint } from "./core.js";
import { Env } from "./env.js";
import { FreedError } from "./errors.js";
import { guarded, memory } from "./module.js";
import { yamlOf } from "./yaml.js";

/** Everything that environments of one configuration share, so that further ones are cheap. */
export class Blueprint {
  /** @type {CoreBlueprint | undefined} */
  #core;

  /**
   * Builds the scene.
   * @param {import("./types.js").Settings | string} [config] values by key, or the text of a YAML file
   * @param {string} [name] of the file, for errors
   * @param {import("./types.js").Assets} [assets] files by path, with a custom scene and its textures
   */
  constructor(config = {}, name = "configuration", assets = {}) {
    const [yaml, file, { paths, contents }] = [yamlOf(config), text("name", name), files("assets", assets)];
    memory();
    this.#core = guarded(() => new CoreBlueprint(yaml, file, paths, contents));
  }

  /** Makes an environment. */
  env() {
    return new Env(this);
  }

  /** The complete configuration, as the text of a YAML file. */
  get yaml() {
    return guarded(() => this.core.toYaml());
  }

  /**
   * The complete configuration by key.
   * @returns {import("./types.js").Config}
   */
  get config() {
    return Object.fromEntries(guarded(() => this.core.config()));
  }

  /** Frees the memory. Environments made from it keep working. A second call throws a `FreedError`. */
  free() {
    const { core } = this;
    this.#core = undefined;
    guarded(() => core.free());
  }

  /** Frees the memory at the end of a block with `using`, unless it was freed before. */
  [Symbol.dispose]() {
    if (this.#core) this.free();
  }

  /** @internal */
  get core() {
    if (!this.#core) throw new FreedError("blueprint");
    return this.#core;
  }
}
