// Environments in a worker: the same calls as of `Env`, each of which returns a promise.

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

  /** @param {Worker} worker */
  constructor(worker) {
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
    const call = this.#calls++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(call, { resolve, reject });
      this.#worker.postMessage({ call, env, what, args });
    });
  }

  /**
   * Makes an environment.
   * @param {import("./types.js").Settings | string} [config] values by key, or the text of a YAML file
   * @param {string} [name] of the file, for errors
   */
  async create(config = {}, name) {
    return new RemoteEnv(this, await this.send(undefined, "create", [config, name]));
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
   * @param {string} what
   * @param {...unknown} args
   * @returns {Promise<any>}
   */
  call(what, ...args) {
    return this.#connection.send(this.#id, what, args);
  }

  /** Frees the environment. */
  free() {
    return this.call("free");
  }
}

/** Starts a worker in a browser. */
export function connect() {
  return new Connection(new Worker(new URL("./worker.js", import.meta.url), { type: "module" }));
}
