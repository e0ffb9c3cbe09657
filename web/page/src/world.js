// The page's side of the connection to the worker that owns the world.

/** @typedef {import("./types").Moment} Moment */

/** A request that the worker refused: the message is the library's. */
export class WorldError extends Error {
  /**
   * @param {string} message
   * @param {string | null} [key] of the configuration that is at fault
   */
  constructor(message, key = null) {
    super(message);
    this.key = key;
  }
}

/** Milliseconds after which a worker that does not answer counts as hung. */
const PATIENCE = 10_000;
/** Milliseconds between checks that the worker answers. */
const LOOK = 1000;

export class World {
  /**
   * @param {URL} script
   * @param {{ frame: (frame: Float32Array, moment: Moment, second?: boolean) => void, event: (name: string, data?: any) => void, died: (why: string) => void, busy: () => boolean }} to
   * @param {Worker} [worker] one that was started before
   */
  constructor(script, to, worker = World.worker(script)) {
    this.to = to;
    /** @type {Map<number, { resolve: (value: any) => void, reject: (error: Error) => void, name: string }>} */
    this.waiting = new Map();
    this.next = 1;
    this.alive = true;
    this.worker = worker;
    this.heard = performance.now();
    /** The time of the last unanswered ping. */
    this.pinged = 0;
    this.hung = false;
    this.watch = setInterval(() => this.look(), LOOK);
    this.worker.onmessage = (e) => this.hear(e.data);
    this.worker.onerror = (e) => this.die(e.message || "The worker could not be loaded.");
    this.worker.onmessageerror = () => this.die("A message could not be read.");
  }

  /**
   * Starts a worker, which loads the module meanwhile.
   * @param {URL} script
   */
  static worker(script) {
    const worker = new Worker(script, { type: "module", name: "world" });
    worker.postMessage({ id: 0, name: "warm", args: [] });
    return worker;
  }

  /** Pings a busy worker that does not answer. */
  look() {
    const now = performance.now();
    if (document.hidden) this.pinged &&= now; // no user waits, and clocks of hidden pages are slow
    else if (!this.pinged) {
      if (now - this.heard < LOOK || (!this.waiting.size && !this.to.busy())) return;
      this.pinged = now;
      this.worker.postMessage({ ping: true });
    } else if (!this.hung && now - this.pinged > PATIENCE) {
      this.hung = true;
      this.to.event("hung");
    }
  }

  /** @param {any} d */
  hear(d) {
    this.heard = performance.now();
    this.pinged = 0;
    if (this.hung) {
      this.hung = false;
      this.to.event("awake");
    }
    if (d.pong) return;
    if (d.frame) {
      const frame = new Float32Array(d.frame);
      this.to.frame(frame, d.moment, d.second);
      if (this.alive) this.worker.postMessage({ back: d.frame, second: d.second }, [d.frame]);
    } else if (d.id) {
      const w = this.waiting.get(d.id);
      this.waiting.delete(d.id);
      if (!w) return;
      if (d.error === undefined) w.resolve(d.value);
      else w.reject(new WorldError(d.error, d.key));
      if (d.fatal) this.die(d.error);
    } else if (d.fatal) this.die(d.fatal);
    else this.to.event(d.event, d.data);
  }

  /**
   * Asks the worker and waits for its answer.
   * @param {string} name
   * @param {...unknown} args
   * @returns {Promise<any>}
   */
  ask(name, ...args) {
    return new Promise((resolve, reject) => {
      if (!this.alive) return reject(new WorldError("The simulation has stopped. Start it again."));
      const id = this.next++;
      this.waiting.set(id, { resolve, reject, name });
      this.worker.postMessage({ id, name, args });
    });
  }

  /**
   * Sends a message to the worker. Errors arrive as an event.
   * @param {string} name
   * @param {...unknown} args
   */
  tell(name, ...args) {
    if (this.alive) this.worker.postMessage({ id: 0, name, args });
  }

  /** @param {string} why */
  die(why) {
    if (!this.alive) return;
    this.stop(why);
    this.to.died(why);
  }

  /** @param {string} why the error of all requests that wait for an answer */
  stop(why) {
    this.alive = false;
    clearInterval(this.watch);
    this.worker.terminate();
    for (const { reject } of this.waiting.values()) reject(new WorldError(why));
    this.waiting.clear();
  }
}
