// Environments in a worker, with the calls of `Env`, each of which returns a promise.
import { files, refuse, text } from "./check.js";
import { MissingError } from "./errors.js";
import { yamlOf } from "./yaml.js";

/**
 * A worker with environments.
 *
 * ```js
 * import { connect } from "babybench/remote";
 * const worker = connect();
 * const env = await worker.create({ behavior: "self_touch", scene: "crib" });
 * await env.call("reset", 0);
 * const { observation } = await env.call("step", await env.call("sampleAction"));
 * ```
 */
export class Connection {
  #worker;
  #calls = 0;
  /** @type {Map<number, { resolve: (value: any) => void, reject: (error: Error) => void }>} */
  #waiting = new Map();

  /** @type {Error | undefined} why the connection has ended */
  #over;

  /** @param {Worker} worker */
  constructor(worker) {
    if (typeof worker?.postMessage !== "function") refuse("worker", worker, "a Worker");
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#settle(data);
    worker.onerror = (event) => this.#die(new Error(event.message || "the worker could not be loaded"));
  }

  /** @param {{ call: number, value?: unknown, error?: { name: string, message: string } }} answer */
  #settle({ call, value, error }) {
    const waiting = this.#waiting.get(call);
    this.#waiting.delete(call);
    if (error) waiting?.reject(Object.assign(new Error(error.message), error));
    else waiting?.resolve(value);
  }

  /** @param {Error} error */
  #die(error) {
    this.#over ??= error;
    for (const { reject } of this.#waiting.values()) reject(error);
    this.#waiting.clear();
  }

  /**
   * @param {number | undefined} env
   * @param {string} what
   * @param {unknown[]} args
   * @returns {Promise<any>}
   */
  send(env, what, args) {
    if (this.#over) return Promise.reject(this.#over);
    const call = this.#calls++;
    return new Promise((resolve, reject) => {
      this.#worker.postMessage({ call, env, what, args }); // throws where something cannot be copied
      this.#waiting.set(call, { resolve, reject });
    });
  }

  /**
   * Makes an environment.
   * @param {import("./types.js").Settings | string} [config] values by key, or the text of a YAML file
   * @param {string} [name] of the file, for errors
   * @param {import("./types.js").Assets} [assets] files by path, with a custom scene and its textures
   */
  async create(config = {}, name = "configuration", assets = {}) {
    files("assets", assets); // refused here, where the caller is
    const args = [yamlOf(config), text("name", name), assets];
    return new RemoteEnv(this, await this.send(undefined, "create", args));
  }

  /** Ends the worker and all its environments. */
  close() {
    this.#worker.terminate();
    this.#die(new Error("the worker was closed"));
  }
}

/** An environment in a worker. What it returns are copies. */
export class RemoteEnv {
  #connection;
  #id;

  /**
   * @param {Connection} connection
   * @param {number} id
   */
  constructor(connection, id) {
    this.#connection = connection;
    this.#id = id;
  }

  /**
   * Calls a method of the environment, or reads a property, by name; see `Env`.
   * @template {import("./calls.js").Asked} K
   * @param {K} what
   * @param {import("./calls.js").Arguments<K>} args
   * @returns {Promise<import("./calls.js").Answer<K>>}
   */
  async call(what, ...args) {
    text("what", what);
    return this.#connection.send(this.#id, what, args);
  }

  /** Frees the environment. */
  free() {
    return this.call("free");
  }
}

/** Starts a worker: in browsers, Deno and Bun. */
export function connect() {
  if (typeof Worker !== "function") throw new MissingError("there is no `Worker` here, as in node: use `Env` itself, in a thread of `node:worker_threads` if it must not block");
  return new Connection(new Worker(new URL("./worker.js", import.meta.url), { type: "module" }));
}
