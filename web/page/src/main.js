// The entry point of the page: puts its parts together and starts the world.
import { App } from "./app.js";
import { $, calm } from "./dom.js";
import { help } from "./panels/help.js";
import { move } from "./panels/move.js";
import { fatal, hideVeil, notices, veil } from "./panels/notices.js";
import { setup } from "./panels/setup.js";
import { share } from "./panels/share.js";
import { tabs } from "./panels/tabs.js";
import { caption, transport } from "./panels/transport.js";
import { watch } from "./panels/watch.js";
import { fromFile } from "./recording.js";
import { readRoom } from "./room.js";
import { drawnInSoftware } from "./stage/graphics.js";
import { HEAT, heatGradient, place, SCALE } from "./stage/heat.js";
import { Pointer } from "./stage/pointer.js";
import { Stage } from "./stage/stage.js";
import { kept } from "./storage.js";
import { World } from "./world.js";
import { el } from "./dom.js";

/** Milliseconds between pictures of MIMo's eyes. */
const GLANCE = 100;

function stageOrExplain() {
  if (typeof WebAssembly !== "object") {
    fatal("WebAssembly is missing", "MIMo's simulation is a WebAssembly module. Allow WebAssembly in this browser, or open the page in a current Firefox, Chrome, Edge or Safari.");
    return null;
  }
  try {
    const plain = drawnInSoftware() && new URLSearchParams(location.search).get("quality") !== "full";
    return new Stage(/** @type {HTMLCanvasElement} */ ($("scene")), plain);
  } catch {
    fatal("WebGL is missing", "The scene is drawn with WebGL 2. Turn on hardware acceleration in the browser's settings, or open the page in a current Firefox, Chrome, Edge or Safari.");
    return null;
  }
}

/** @param {Stage} stage */
function theme(stage) {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  let chosen = [kept("theme")].find((name) => name === "light" || name === "dark") ?? null;
  const apply = () => {
    const name = /** @type {"light" | "dark"} */ (chosen ?? (dark.matches ? "dark" : "light"));
    document.documentElement.dataset.theme = name;
    stage.theme = name;
    if (stage.peer) stage.peer.theme = name;
  };
  dark.addEventListener("change", apply);
  $("theme").addEventListener("click", () => {
    chosen = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    kept("theme", chosen);
    apply();
  });
  apply();
}

/**
 * Shows a hint on the scene until the user has pulled MIMo once.
 * @param {App} app
 */
function hint(app) {
  const text = $("hint");
  app.on("scene", () => (text.hidden = kept("pulled") !== null));
  app.on("pull", () => {
    kept("pulled", "yes");
    text.classList.add("gone");
  });
}

/**
 * Shows only the scene and its time, for a frame in another page: `?embed`. A link leads to the whole page in the same state.
 * @param {App} app
 */
function embed(app) {
  if (!new URLSearchParams(location.search).has("embed")) return;
  document.documentElement.dataset.embed = "";
  const whole = /** @type {HTMLAnchorElement} */ (/** @type {unknown} */ ($("whole")));
  whole.hidden = false;
  const url = new URL(location.href);
  url.searchParams.delete("embed");
  whole.href = url.href;
  whole.addEventListener("pointerdown", () => app.attempt(async () => {
    url.hash = new URL(await app.sharing.address(true)).hash;
    whole.href = url.href;
  }));
}

/** @param {App} app */
function legend(app) {
  app.on("scene", (/** @type {import("./types").Scene} */ s) => ($("legend").hidden = s.skin.of.length === 0));
  $("ramp").style.background = heatGradient();
  $("ticks").append(...SCALE.map((f, i) => {
    const tick = el("span", {}, i === SCALE.length - 1 ? `${f} N` : String(f));
    tick.style.left = `${100 * place(f)}%`;
    return tick;
  }));
  return HEAT.length;
}

/**
 * Requests pictures of the eyes while the page is visible, as often as a viewer can follow.
 * @param {App} app
 */
function glances(app) {
  let waiting = false;
  let seen = -1;
  setInterval(async () => {
    const m = app.moment;
    if (waiting || !m || document.hidden || $("panel-watch").hidden || m.time === seen || !app.world.alive) return;
    waiting = true;
    seen = m.time;
    try {
      app.emit("eyes", await app.world.ask("eyes"));
      if (app.second.scene) app.emit("second eyes", await app.world.ask("eyes", true));
    } catch (e) {
      if (app.world.alive) app.notice(`The eyes cannot be drawn: ${/** @type {Error} */ (e).message}`, true);
      return;
    }
    waiting = false;
  }, GLANCE);
  app.on("scene", () => {
    seen = -1;
    waiting = false;
  });
}

/**
 * Files may be dropped anywhere.
 * @param {App} app
 */
function drops(app) {
  document.addEventListener("dragover", (e) => e.preventDefault());
  document.addEventListener("drop", (e) => {
    e.preventDefault();
    const items = Array.from(e.dataTransfer?.items ?? [], (item) => item.webkitGetAsEntry?.() ?? item.getAsFile());
    const things = items.filter((thing) => thing !== null);
    const file = e.dataTransfer?.files[0];
    if (!file || !things.length) return;
    app.attempt(async () => {
      if (things.length > 1 || !(things[0] instanceof File || things[0].isFile) || /\.(zip|xml)$/i.test(file.name)) return app.enter(await readRoom(things));
      if (/\.npz$/i.test(file.name)) await app.recordings.replay(await fromFile(new Uint8Array(await file.arrayBuffer())));
      else if (/\.ya?ml$/i.test(file.name)) await app.make({}, null, await file.text());
      else if (/\.onnx$/i.test(file.name)) {
        await app.bring({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), url: null });
      } else throw new Error(`${file.name} is not a recording (.npz), model (.onnx), configuration (.yml) or room (.xml, .zip or a folder).`);
    });
  });
}

/**
 * Keeps the page's files in the browser, and announces newer ones.
 * @param {App} app
 */
async function keepFiles(app) {
  if (!("serviceWorker" in navigator) || location.protocol === "file:") return;
  const before = navigator.serviceWorker.controller;
  navigator.serviceWorker.addEventListener("controllerchange", () => {
    if (before) app.notice("There is a newer version of this page: it shows after a reload.");
  });
  await navigator.serviceWorker.register("./sw.js").catch(() => {}); // the page works without
}

async function main() {
  performance.mark("page");
  const script = new URL("./worker.js", import.meta.url);
  const worker = World.worker(script); // before the graphics, which take long to open
  const stage = stageOrExplain();
  if (!stage) {
    worker.terminate();
    return hideVeil();
  }
  const app = new App(stage, script, worker);
  theme(stage);
  legend(app);
  notices(app);
  const openHelp = help(app);
  transport(app);
  caption(app);
  new Pointer(stage, { pull: (p) => app.pull(p), release: () => app.letGo(), mayPull: (b) => app.movable(b) });
  tabs({ Watch: watch(app), Move: move(app), Setup: setup(app), Share: share(app) }, () => app.moment && app.emit("tick", app.moment));
  $("home").addEventListener("click", () => stage.home());
  stage.canvas.addEventListener("webglcontextlost", (e) => {
    e.preventDefault();
    app.notice("The graphics were reset. The picture returns in a moment.", true);
  });
  hint(app);
  embed(app);
  drops(app);
  document.addEventListener("visibilitychange", () => app.world.tell("asleep", document.hidden));
  // for the console and for tests
  Object.assign(globalThis, { mimo: app, mimoHelp: openHelp });
  try {
    const started = app.start();
    stage.compile();
    const continued = await started;
    glances(app);
    stage.after.push(hideVeil, () => performance.mark("first frame"));
    stage.invalidate();
    if (!continued && !calm() && !new URLSearchParams(location.search).has("paused")) app.play(true);
  } catch (e) {
    if (app.world.alive) app.announce("lost", e instanceof Error ? e.message : String(e)); // else it was announced already
    hideVeil();
  }
  keepFiles(app);
}

veil("Loading MIMo");
main();
