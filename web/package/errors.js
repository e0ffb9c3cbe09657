// Errors beyond the library's own.

/** The module stopped for good: it ran out of memory, or met a fault of its own. Nothing in it can be used any more. */
export class ModuleError extends Error {
  /** @param {unknown} cause */
  constructor(cause) {
    super(
      "the simulation stopped: it ran out of memory, or met a fault; reload the page or the module, with fewer or " +
        "smaller pictures, a larger touch_scale or fewer environments",
      { cause },
    );
    this.name = "ModuleError";
  }
}

/** An argument has the wrong type or is out of range. */
export class ArgumentError extends TypeError {
  /**
   * @param {string} argument its name, with the place of a value in it, as `qpos[3]`
   * @param {string} problem
   */
  constructor(argument, problem) {
    super(`${argument}: ${problem}`);
    this.name = "ArgumentError";
    this.argument = argument;
  }
}

/** Something was used after its `free`. */
export class FreedError extends Error {
  /** @param {string} what */
  constructor(what) {
    super(`the ${what} was freed: make another one`);
    this.name = "FreedError";
  }
}

/** Something that this JavaScript environment lacks, or that is not loaded yet. */
export class MissingError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "MissingError";
  }
}

/** @typedef {<T>(call: () => T) => T} Guard */

/**
 * Creates the guard of a module, which runs calls into it and turns a trap into a {@link ModuleError}. After a trap no call
 * reaches the module, because its state is incomplete.
 * @returns {Guard}
 */
export function guard() {
  /** @type {ModuleError | undefined} */
  let lost;
  return (call) => {
    if (lost) throw new ModuleError(lost.cause);
    try {
      return call();
    } catch (error) {
      // a stack that overflows is a RangeError; arguments that could cause one are checked before
      if (!(error instanceof WebAssembly.RuntimeError) && !(error instanceof RangeError)) throw error;
      throw (lost = new ModuleError(error));
    }
  };
}
