// BabyBench in JavaScript: MIMo, its scenes, senses and muscles, behind Gymnasium's reset and step.
import { Blueprint } from "./blueprint.js";
import start, { configKeys as coreKeys } from "./core.js";
import { Env } from "./env.js";
import { ArgumentError, FreedError, MissingError, ModuleError } from "./errors.js";
import { loadFace } from "./faces.js";
import { locate, once } from "./load.js";
import { guarded, memory, module } from "./module.js";
import { ActionNoise } from "./noise.js";

export { ActionNoise, ArgumentError, Blueprint, Env, FreedError, loadFace, MissingError, ModuleError };

/** @typedef {import("./types.js").Settings} Settings */
/** @typedef {import("./types.js").Assets} Assets */
/** @typedef {import("./types.js").ConfigKey} ConfigKey */
/** @typedef {import("./types.js").Observation} Observation */
/** @typedef {import("./types.js").Step} Step */
/** @typedef {import("./types.js").Info} Info */
/** @typedef {import("./types.js").FreeCamera} FreeCamera */

/**
 * Loads the module once, before anything else is used. Without a source it loads the file `core_bg.wasm` next to this
 * one.
 * @type {(source?: import("./load.js").Source) => Promise<void>}
 */
const init = once(async (source) => {
  const bytes = await locate(source, new URL("core_bg.wasm", import.meta.url));
  ({ memory: module.memory } = await start({ module_or_path: bytes }));
});
export default init;

/**
 * Lists the keys of a configuration: names, sections, allowed values, defaults, meanings.
 * @returns {ConfigKey[]}
 */
export const configKeys = () => (memory(), guarded(coreKeys));

/** Returns the memory that the module takes, bytes. It never shrinks. */
export const memoryBytes = () => module.memory?.buffer.byteLength ?? 0;
