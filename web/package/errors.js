// Errors beyond those that the library tells by name.

/** The module stopped for good: it ran out of memory, or met a fault of its own. Nothing in it can be used any more. */
export class ModuleError extends Error {
  /** @param {unknown} cause */
  constructor(cause) {
    super(
      "the simulation stopped: it ran out of memory, or met a fault; load the page or the module anew, with fewer or " +
        "smaller pictures, a larger touch_scale or fewer environments",
      { cause },
    );
    this.name = "ModuleError";
  }
}

/**
 * Runs a call into a module; a trap becomes a {@link ModuleError}.
 * @template T
 * @param {() => T} call
 * @returns {T}
 */
export function guarded(call) {
  try {
    return call();
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) throw new ModuleError(error);
    throw error;
  }
}
