// The loaded module, which the files of the package share.
import { guard, MissingError } from "./errors.js";

/** @type {{ memory?: WebAssembly.Memory }} */
export const module = {};

/** Runs a call into the module. */
export const guarded = guard();

/** Returns the module's current memory. A memory that grows gets another buffer. */
export function memory() {
  if (!module.memory) throw new MissingError("the module is not loaded: `await init()` first");
  return module.memory.buffer;
}
