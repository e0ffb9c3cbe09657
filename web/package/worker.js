// A worker that holds environments, so that no step freezes the page. `remote.js` is its other end.
import init, { Blueprint, Env, loadFace } from "./babybench.js";
import { METHODS, PROPERTIES } from "./calls.js";
import { FreedError } from "./errors.js";

/** @type {Map<number, Env>} */
const environments = new Map();
let next = 0;

/** @type {ReadonlySet<string>} */
const methods = new Set(METHODS);
/** @type {ReadonlySet<string>} */
const properties = new Set(PROPERTIES);

/**
 * Copies views on the module's memory, which must not leave the worker.
 * @param {unknown} value
 * @param {Transferable[]} moved buffers that go along
 * @returns {unknown}
 */
function copied(value, moved) {
  if (ArrayBuffer.isView(value)) {
    const copy = /** @type {Uint8Array} */ (value).slice();
    moved.push(/** @type {ArrayBuffer} */ (copy.buffer));
    return copy;
  }
  if (Array.isArray(value)) return value.map((v) => copied(v, moved));
  if (value !== null && typeof value === "object") {
    return Object.fromEntries(Object.entries(value).map(([key, v]) => [key, copied(v, moved)]));
  }
  return value;
}

/**
 * @param {{ env?: number, what: string, args: any[] }} call
 * @returns {Promise<unknown>}
 */
async function answer({ env: id, what, args }) {
  if (what === "create") {
    await init();
    const blueprint = new Blueprint(args[0], args[1], args[2]);
    await loadFace(String(blueprint.config.facial_expression));
    environments.set(next, new Env(blueprint));
    blueprint.free();
    return next++;
  }
  const env = environments.get(/** @type {number} */ (id));
  if (!env) throw new FreedError("environment");
  if (what === "free") {
    environments.delete(/** @type {number} */ (id));
    return env.free();
  }
  if (what === "swapFacialExpression") await loadFace(args[0]);
  const any = /** @type {any} */ (env);
  if (methods.has(what)) return any[what](...args);
  if (properties.has(what)) return any[what];
  throw new Error(`an environment has no ${what}`);
}

const scope = /** @type {any} */ (globalThis);

/** @param {any} data */
async function receive(data) {
  /** @type {Transferable[]} */
  const moved = [];
  try {
    const value = copied(await answer(data), moved);
    scope.postMessage({ call: data.call, value }, moved);
  } catch (error) {
    const { name, message, key, line, column, argument } = /** @type {any} */ (error);
    scope.postMessage({ call: data.call, error: { name, message, key, line, column, argument } });
  }
}
scope.onmessage = (/** @type {MessageEvent} */ event) => receive(event.data);
