// The page's end of the line to the worker that owns the world.

/** @typedef {import("./types").Moment} Moment */

/** A request that the worker refused: the message is the library's. */
export class WorldError extends Error {}

/** Milliseconds after which a silent worker is reported. */
const PATIENCE = 15_000;

export class World {
  /**
   * @param {URL} script
   * @param {{ frame: (frame: Float32Array, moment: Moment) => void, event: (name: string, data: any) => void, died: (why: string) => void }} to
   * @param {Worker} [worker] one that was started before
   */
  constructor(script, to, worker = World.worker(script)) {
    this.to = to;
    /** @type {Map<number, { resolve: (value: any) => void, reject: (error: Error) => void, name: string }>} */
    this.waiting = new Map();
    this.next = 1;
    this.alive = true;
    this.worker = worker;
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

  /** @param {any} d */
  hear(d) {
    if (d.frame) {
      const frame = new Float32Array(d.frame);
      this.to.frame(frame, d.moment);
      if (this.alive) this.worker.postMessage({ back: d.frame }, [d.frame]);
    } else if (d.id) {
      const w = this.waiting.get(d.id);
      this.waiting.delete(d.id);
      if (!w) return;
      if (d.error === undefined) w.resolve(d.value);
      else w.reject(new WorldError(d.error));
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
      setTimeout(() => {
        if (this.waiting.has(id)) this.to.event("slow", { name });
      }, PATIENCE);
    });
  }

  /**
   * Tells the worker; what goes wrong comes as an event.
   * @param {string} name
   * @param {...unknown} args
   */
  tell(name, ...args) {
    if (this.alive) this.worker.postMessage({ id: 0, name, args });
  }

  /** @param {string} why */
  die(why) {
    if (!this.alive) return;
    this.alive = false;
    this.worker.terminate();
    for (const { reject } of this.waiting.values()) reject(new WorldError(why));
    this.waiting.clear();
    this.to.died(why);
  }

  stop() {
    this.alive = false;
    this.worker.terminate();
    this.waiting.clear();
  }
}
