// The worker: it owns the world, and answers the page.
import { inMilliseconds } from "../delays.js";
import { fetchFace, load, PageEnv } from "./env.js";
import { Model } from "./model.js";
import { LiveWorld } from "./world.js";

/** @typedef {import("./world.js").Movement} Movement */

/** @type {LiveWorld | null} */
let live = null;
let wanted = false;

const post = (/** @type {any} */ message, /** @type {Transferable[]} */ transfer = []) => postMessage(message, { transfer });
const event = (/** @type {string} */ name, /** @type {unknown} */ data) => post({ event: name, data });

function world() {
  if (!live) throw new Error("There is no world yet.");
  return live;
}

/** The running world, or the one next to it. @param {boolean} [second] */
function of(second) {
  const w = second ? world().twin : world();
  if (!w) throw new Error("MIMo is alone.");
  return w;
}

/**
 * Makes a network the policy of the world.
 * @param {Uint8Array} bytes
 */
async function bring(bytes) {
  const w = world();
  const model = await Model.load(bytes, w.env);
  w.model?.free();
  w.past.forget();
  w.model = model;
  return model.about;
}

/**
 * Whether the module is unusable because it trapped or ran out of memory.
 * @param {unknown} e
 */
const deadly = (e) => e instanceof WebAssembly.RuntimeError || (e instanceof RangeError && /memory/i.test(e.message)) || (e instanceof Error && e.name === "ModuleError");

/**
 * @param {string} name of the event
 * @param {unknown} e
 */
function failed(name, e) {
  if (deadly(e)) post({ fatal: String(e) });
  else event(name, e instanceof Error ? e.message : String(e));
}

/**
 * Stops the clock on an error; time is paused until the user continues.
 * @param {unknown} e
 */
function stopped(e) {
  wanted = false;
  failed("stopped", e);
}

/**
 * Creates an environment and moves it to its start.
 * @param {{ settings: import("../types").Settings | string, assets?: Record<string, Uint8Array>, seed: number, locks: string[], snapshot: Uint8Array | null }} d
 */
function build(d) {
  const env = new PageEnv(d.settings, d.assets);
  try {
    env.reset(d.seed);
    for (const joint of d.locks) env.lock(joint, true);
    if (d.snapshot) env.restore(d.snapshot);
    return env;
  } catch (e) {
    env.free();
    throw e;
  }
}

/**
 * Creates the world beside the running one, with its settings except its own, and its time.
 * @param {LiveWorld} beside
 * @param {any} d as for `make`
 */
async function pair(beside, d) {
  const { age, policy, sensory, motor } = /** @type {import("../types").Twin} */ (d.twin);
  const { settings, seconds, assets } = beside.env;
  const own = { ...settings, ...inMilliseconds(settings, seconds), age, delay_by_age: settings.delay_by_age && !sensory, delay_sensory: sensory, delay_motor: motor };
  const env = build({ ...d, settings: own, assets, snapshot: d.second });
  const to = { frame: (/** @type {ArrayBuffer} */ frame, /** @type {unknown} */ moment) => post({ frame, moment, second: true }, [frame]), event: (/** @type {string} */ name, /** @type {any} */ data) => name === "episode" && event(name, { ...data, second: true }), fail: stopped };
  const world = new LiveWorld(env, { ...d, policy }, to, beside.clock);
  try {
    if (policy === "model") world.model = await Model.load(d.network, env);
  } catch (e) {
    world.free();
    throw e;
  }
  return world;
}

/** The requests of the page, by name. */
/** @type {Record<string, (...args: any[]) => unknown>} */
const answers = {
  load: () => load(),
  /** Loads ahead of time. A later request reports errors. */
  warm: () => load().then(() => {}, () => {}),

  /** @param {{ settings: import("../types").Settings | string, assets?: Record<string, Uint8Array>, locks: string[], snapshot: Uint8Array | null, network?: Uint8Array, twin?: import("../types").Twin | null, second?: Uint8Array | null } & Movement} d */
  async make(d) {
    await load();
    await fetchFace(d.settings, d.assets);
    live?.clock.play(false);
    const last = live && { settings: live.env.yaml, assets: live.env.assets, snapshot: live.env.snapshot(), seed: 0, locks: [] };
    live?.stay();
    // two worlds at once would take twice the memory, and fragment it
    live?.env.free();
    /** @type {PageEnv} */
    let env;
    try {
      env = build(d);
    } catch (e) {
      if (live && last) live.env = build(last);
      live?.clock.play(wanted);
      throw e;
    }
    live?.model?.free();
    live?.twin?.free();
    const strength = live?.spring.strength;
    live = new LiveWorld(env, d, { frame: (buffer, moment) => post({ frame: buffer, moment }, [buffer]), event, fail: stopped });
    if (strength !== undefined) live.spring.strength = strength;
    const made = live;
    const failed = (/** @type {unknown} */ e) => {
      if (deadly(e)) throw e;
      return e instanceof Error ? e.message : String(e);
    };
    const misfit = d.network && d.policy === "model" ? await bring(d.network).then(() => null, failed) : null;
    const alone = d.twin ? await pair(made, d).then((twin) => void (made.twin = twin), failed) : null;
    const { twin } = made;
    if (twin && strength !== undefined) twin.spring.strength = strength;
    live.clock.play(wanted);
    return { ...env.scene(), layout: made.layout, misfit, alone, twin: twin && { ...twin.env.scene(), layout: twin.layout } };
  },
  look: () => world().show(),
  play(/** @type {boolean} */ on) {
    wanted = on;
    if (on) live?.stay();
    live?.clock.play(on); // a world under construction plays when it is ready
    if (!on) live?.show();
  },
  asleep(/** @type {boolean} */ asleep) {
    live?.clock.play(wanted && !asleep);
  },
  step(/** @type {number} */ n) {
    world().steps(n);
  },
  reset: (/** @type {number} */ seed) => world().reset(seed),
  move: (/** @type {Movement} */ m) => world().move(m),
  strength: (/** @type {number} */ v) => [world(), world().twin].forEach((w) => w && (w.spring.strength = v)),
  /** Goes to a moment of the past, where time pauses. */
  seek(/** @type {number} */ step) {
    wanted = false;
    return world().seek(step);
  },
  pull(/** @type {any} */ held, /** @type {boolean} */ second) {
    if (held) world().forget();
    of(second).hold(held);
  },
  lock: (/** @type {string} */ part, /** @type {boolean} */ on) => world().lock(part, on),
  /** @param {string} name of a face, for both */
  async face(name) {
    const { env, twin } = world();
    return { scene: await env.face(name), twin: (await twin?.env.face(name)) ?? null };
  },
  snapshot: (/** @type {boolean} */ second) => (second && !world().twin ? null : of(second).env.snapshot()),
  eyes: (/** @type {boolean} */ second) => of(second).env.eyes(),
  keys: () => PageEnv.keys(),
  record: () => world().record(),
  endRecording: () => world().endRecording(),
  replay: (/** @type {import("../types").Recording} */ r) => world().startReplay(r),
  model: async (/** @type {Uint8Array} */ bytes) => bring(bytes),
  checksum: (/** @type {boolean} */ second) => of(second).env.checksum(),
};

onmessage = async ({ data }) => {
  if (data.ping) return post({ pong: true });
  if (data.back) return (data.second ? live?.twin : live)?.back(data.back);
  const { id, name, args } = data;
  try {
    const value = await answers[name](...args);
    if (id) post({ id, value });
  } catch (e) {
    const fatal = deadly(e);
    const error = e instanceof Error ? e.message : String(e);
    const key = /** @type {any} */ (e)?.key ?? null;
    if (id) post({ id, error, key, fatal });
    else failed("error", e);
  }
};
