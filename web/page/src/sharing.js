// The page and its links: opens the contents of an address, and writes the page's state into one.
import * as link from "./link.js";
import { fromFile } from "./recording.js";
import { roomOf, sceneOf } from "./room.js";
import { checked, FIRST } from "./state.js";
import { WorldError } from "./world.js";

/** @typedef {import("./types").PageState} PageState */
/** @typedef {import("./link.js").Link} Link */

/** Largest network in a link, packed bytes: messengers accept links of up to a hundred thousand characters. */
const LARGEST = 64 << 10;
/** Largest room that outlives a reload, bytes: browsers keep a few megabytes. */
const REMEMBERED = 4 << 20;
/** Delay before a change is stored, ms: sliders change often. */
const LATER = 300;

export class Sharing {
  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    /** The contents of the link in the address bar, if there is one. */
    /** @type {string | null} */
    this.linked = null;
    this.opening = false;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.later = undefined;
    app.on("state", () => {
      clearTimeout(this.later);
      this.later = setTimeout(() => this.remember(), LATER);
    });
    addEventListener("pagehide", () => this.remember());
    // also from a pasted address, but never from one that the page wrote itself
    addEventListener("popstate", () => app.attempt(() => this.follow()));
  }

  /** The state for a link, without default values. */
  get state() {
    const { state, scene, stage, model } = this.app;
    const network = (state.policy === "model" || state.twin?.policy === "model") && model ? { name: model.name, size: model.bytes.length, url: model.url } : undefined;
    return { ...state, settings: scene ? scene.changed : state.settings, view: stage.orbit.view, network };
  }

  /** The files of MIMo's room, if it is the user's own. */
  get room() {
    const { room, state } = this.app;
    return sceneOf(state.settings) === null || !room ? null : room.files;
  }

  /** A key that distinguishes states but ignores the camera. */
  get key() {
    return JSON.stringify({ ...this.state, view: null });
  }

  /** Stores the state in this entry of the history, for a reload. An outdated link becomes the previous entry. */
  remember() {
    if (!this.app.scene || this.opening || window !== top) return; // the history of a frame is that of the page around it
    if (this.linked !== null && this.linked === this.key) return;
    const { model } = this.app;
    const { room } = this;
    const small = room && Object.values(room).reduce((sum, bytes) => sum + bytes.length, 0) < REMEMBERED;
    const kept = { state: this.state, network: this.state.network && model ? model.bytes : null, room: small ? room : null };
    const plain = location.pathname + location.search;
    if (this.linked === null) history.replaceState(kept, "", plain);
    else history.pushState(kept, "", plain);
    this.linked = null;
  }

  /** Starts from the address: a link, the state of this entry of the history, or `?config=`; then `?policy=` and `?recording=`. */
  async start() {
    const query = new URLSearchParams(location.search);
    const opened = await this.arrive();
    if (!opened) {
      const yaml = await this.fetched(query.get("config"), (answer) => answer.text());
      const made = yaml !== null && (await this.app.attempt(() => this.app.make({}, null, yaml)));
      if (!made) await this.app.make(this.app.state.settings, null);
    }
    const url = query.get("policy");
    const network = this.app.model ? null : await this.fetched(url, (answer) => answer.arrayBuffer());
    if (network && url) await this.app.attempt(() => this.app.bring({ name: nameOf(url), bytes: new Uint8Array(network), url }));
    const recording = opened ? null : await this.fetched(query.get("recording"), (answer) => answer.arrayBuffer());
    if (recording) await this.app.attempt(async () => this.app.recordings.replay(await fromFile(new Uint8Array(recording)), !query.has("paused")));
    return opened === "moment" || recording !== null;
  }

  /** Opens the contents of the address, or of this entry of the history. */
  async arrive() {
    if (/[#&]s=/.test(location.hash)) return this.open(location.hash);
    const kept = history.state;
    return kept?.state ? this.enter({ state: kept.state, snapshot: null, second: null, network: kept.network ?? null, room: kept.room ?? null }) : null;
  }

  /** Follows a change of the address: back, forward, or a pasted link. */
  async follow() {
    clearTimeout(this.later); // the state of before belongs into another entry of the history
    if (!(await this.app.recordings.consent("Another address"))) return;
    this.app.play(false);
    this.linked = null;
    this.opening = true; // also while a link is read
    try {
      if (!(await this.arrive()) && !location.hash) await this.enter({ state: FIRST, snapshot: null, second: null, network: null, room: null });
    } finally {
      this.opening = false;
    }
  }

  /**
   * Opens a link.
   * @param {string} hash
   */
  async open(hash) {
    let found;
    try {
      found = await link.decode(hash);
    } catch {
      this.app.notice(`The link is damaged. ${this.app.scene ? "What is here stays." : "The page starts afresh."}`, true);
    }
    const opened = found ? await this.enter(found) : null;
    if (opened) this.linked = this.key;
    return opened;
  }

  /**
   * Replaces the state of the page by that of a link. Settings that do not exist are named, and the rest is kept.
   * @param {Link} found
   * @returns {Promise<"moment" | "settings" | null>} nothing if it cannot be opened
   */
  async enter(found) {
    const { app } = this;
    const { state, refused } = checked(found.state);
    const [before, model, room] = [app.state, app.model, app.room];
    app.state = state;
    this.opening = true;
    try {
      if (found.room) app.room = roomOf(Object.entries(found.room));
      await this.network(state, found.network);
      await this.makeOf(state, found, refused);
    } catch (e) {
      app.state = app.scene ? before : structuredClone(FIRST);
      app.model = model;
      app.room = room;
      if (!app.world.alive) app.connectAnew();
      app.notice(`The link cannot be opened: ${/** @type {Error} */ (e).message} ${app.scene ? "What was here stays." : "The page starts afresh."}`, true);
      return null;
    } finally {
      this.opening = false;
    }
    if (state.view) app.stage.orbit.view = state.view;
    if (refused.length) app.announce("refused", refused);
    app.emit("state");
    return found.snapshot ? "moment" : "settings";
  }

  /**
   * Gets the network that moves a state: the link's, that of its address, or the current one. Without one MIMo babbles, and
   * a notice names what is missing.
   * @param {PageState} state
   * @param {Uint8Array<ArrayBuffer> | null} bytes
   */
  async network(state, bytes) {
    const { app } = this;
    const { network } = state;
    delete state.network;
    if (state.policy !== "model" && state.twin?.policy !== "model") return;
    const { name, url, size } = network ?? { name: "a network", url: null, size: 0 };
    const own = app.model?.name === name && app.model.bytes.length === size ? app.model.bytes : null;
    const found = bytes ?? own ?? (await this.fetched(url, async (answer) => new Uint8Array(await answer.arrayBuffer())));
    if (found) {
      app.model = { name, bytes: found, url };
      return;
    }
    app.model = null;
    for (const moved of [state, state.twin]) if (moved?.policy === "model") moved.policy = "babbling";
    app.announce("missing", { name, size });
  }

  /**
   * Builds a world from an external state, without the settings that the library refuses.
   * @param {PageState} state
   * @param {Link} found the snapshot and its parts
   * @param {string[]} refused gets the settings that are left out
   */
  async makeOf(state, { snapshot, second }, refused) {
    const { app } = this;
    const { locks } = state;
    for (;;) {
      try {
        await app.make(state.settings, snapshot, undefined, second);
        const joints = new Set(app.scene?.joints.map((j) => j.name));
        refused.push(...locks.filter((name) => !joints.has(name)).map((name) => `lock ${name}`));
        return;
      } catch (e) {
        const key = e instanceof WorldError && app.world.alive ? e.key : null;
        if (key === null || !(key in state.settings)) throw e;
        refused.push(`${key} ${JSON.stringify(state.settings[key])}`);
        delete state.settings[key];
      }
    }
  }

  /**
   * Fetches a file and shows errors.
   * @template T
   * @param {string | null} url
   * @param {(answer: Response) => Promise<T>} read
   * @returns {Promise<T | null>}
   */
  async fetched(url, read) {
    if (!url) return null;
    try {
      const answer = await fetch(new URL(url, location.href));
      if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
      return await read(answer);
    } catch (e) {
      this.app.notice(`${url} cannot be fetched: ${/** @type {Error} */ (e).message}. Its server may have to allow other pages (CORS).`, true);
      return null;
    }
  }

  /**
   * Returns the address of the page with its state.
   * @param {boolean} withMoment whether it continues from this very moment
   */
  async address(withMoment) {
    return (await this.made(withMoment)).href;
  }

  /**
   * @param {boolean} withMoment
   * @returns {Promise<{ href: string, lacks: string }>} the address, and the parts that it cannot hold
   */
  async made(withMoment) {
    const { app, state } = this;
    const snapshot = withMoment ? await app.world.ask("snapshot") : null;
    const second = withMoment && state.twin ? await app.world.ask("snapshot", true) : null;
    const packed = state.network && app.model && !state.network.url ? await link.pack(app.model.bytes) : null;
    const fits = packed !== null && packed.length <= LARGEST;
    const files = this.room && (await link.packFiles(this.room));
    const held = files !== null && files.length <= LARGEST;
    const href = new URL(`#${await link.encode(state, snapshot, second, fits ? packed : null, held ? files : null)}`, location.href).href;
    const lacks = [];
    if (files && !held) lacks.push(`It does not hold the room ${state.settings.scene} (${(files.length / 1e3).toFixed(0)} kB): to open it, first drop that on the page.`);
    if (packed && !fits) lacks.push(`It does not hold the network ${app.model?.name} (${(packed.length / 1e3).toFixed(0)} kB): to open it, first drop that file on the page, or put it on a server and open this page with ?policy= and its address.`);
    if (app.moment?.replay) lacks.push("A recording plays here, which the link does not hold: from this moment its policy continues.");
    return { href, lacks: lacks.join(" ") };
  }

  /**
   * Writes a link to the address bar. A moment becomes an entry of the history.
   * @param {string} href
   * @param {boolean} moment
   */
  show(href, moment) {
    this.remember();
    if (moment) history.pushState(null, "", href);
    else history.replaceState(null, "", href);
    this.linked = this.key;
  }
}

/** @param {string} url */
const nameOf = (url) => decodeURIComponent(new URL(url, location.href).pathname.split("/").at(-1) || "network.onnx");
