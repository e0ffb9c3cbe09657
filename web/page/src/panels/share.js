// What one takes away: a link, a recording, a picture, a video.
import { download, el, say } from "../dom.js";
import * as link from "../link.js";
import { fromFile, toFile } from "../recording.js";
import { Film, picture } from "../stage/film.js";
import { button, card, drop } from "./controls.js";

/** @param {import("../app.js").App} app */
export function share(app) {
  return el("div", {}, address(app), tape(app), pictures(app));
}

/** @param {import("../app.js").App} app */
function address(app) {
  const shown = el("code", { className: "block", tabindex: 0, "aria-label": "Link" });
  shown.hidden = true;
  const copy = (/** @type {boolean} */ moment) =>
    app.attempt(async () => {
      const href = await app.address(moment);
      link.show(new URL(href).hash.slice(1));
      shown.hidden = false;
      say(shown, href.length > 400 ? `${href.slice(0, 380)}…` : href);
      shown.dataset.href = href;
      try {
        await navigator.clipboard.writeText(href);
        app.notice("The link is in the clipboard.");
      } catch {
        app.notice("The link is in the address bar.");
      }
    });
  return card(
    "Link",
    el("p", { className: "soft small" }, "Everything is in the link; no server keeps it. Opened, this moment goes on with the same bits."),
    el("div", { className: "row" }, button("Copy link to this moment", () => copy(true), "main"), button("Link to the settings", () => copy(false))),
    shown,
  );
}

/** @param {import("../app.js").App} app */
function tape(app) {
  /** @type {import("../types").Recording | null} */
  let last = null;
  const state = el("p", { className: "soft small", role: "status" });
  const record = button("Record", () =>
    app.attempt(async () => {
      if (app.moment?.recorded === null || !app.moment) {
        await app.world.ask("record");
        app.play(true);
      } else {
        last = await app.world.ask("endRecording");
        save.disabled = again.disabled = false;
        app.emit("tick", app.moment);
      }
    }),
  );
  const save = button("Save .npz", () => last && download("recording.npz", toFile(last)));
  const config = button("Save its configuration", () => app.scene && download("babybench.yml", new Blob([app.scene.yaml], { type: "text/yaml" })));
  const again = button("Replay", () => app.attempt(() => replay(app, last)));
  save.disabled = again.disabled = true;
  const command = "babybench replay --config babybench.yml --recording recording.npz --compat api --out replay";
  app.on("tick", (/** @type {import("../types").Moment} */ m) => {
    const on = m.recorded !== null;
    say(record, on ? "Stop" : "Record");
    record.classList.toggle("recording", on);
    const seconds = (/** @type {number} */ n) => `${(n * (app.scene?.timestep ?? 0)).toFixed(1)} s`;
    if (m.replay) say(state, `Replaying ${seconds(m.replay.done)} of ${seconds(m.replay.of)}`);
    else if (on) say(state, `Recording: ${seconds(m.recorded ?? 0)}. Pulling and locking wait until it ends, as a recording knows actions only.`);
    else say(state, last ? `Recorded ${seconds(last.steps)}, ${last.steps} steps.` : "A recording starts a new episode from this very pose.");
  });
  app.on("tape", (/** @type {import("../types").Recording} */ full) => {
    last = full;
    save.disabled = again.disabled = false;
    app.notice("The recording is full and has stopped.");
  });
  return card(
    "Recording",
    state,
    el("div", { className: "row" }, record, again, save, config),
    drop("Drop a recording (.npz) here to replay it", ".npz", (f) => app.attempt(async () => replay(app, await fromFile(new Uint8Array(await f.arrayBuffer()))))),
    el("p", { className: "soft small" }, "On the command line the same bits come from"),
    el("code", { className: "block" }, command),
  );
}

/**
 * @param {import("../app.js").App} app
 * @param {import("../types").Recording | null} recording
 */
export async function replay(app, recording) {
  if (!recording) return;
  if (recording.yaml !== null && recording.yaml !== app.scene?.yaml) await app.make({}, null, recording.yaml);
  app.state.held = {};
  await app.world.ask("replay", recording);
  app.state.policy = "replay";
  app.emit("state");
  app.play(true);
}

/** @param {import("../app.js").App} app */
function pictures(app) {
  const film = new Film(app.stage.canvas);
  const video = button("Record video", () =>
    app.attempt(async () => {
      if (film.running) {
        const clip = await film.stop();
        download(`mimo.${clip.type.includes("mp4") ? "mp4" : "webm"}`, clip);
      } else film.start(() => app.attempt(async () => video.click()));
      say(video, film.running ? "Stop and save" : "Record video");
      video.classList.toggle("recording", film.running);
    }),
  );
  video.disabled = !Film.possible();
  return card(
    "Picture and video",
    el("div", { className: "row" }, button("Save picture", () => app.attempt(async () => download("mimo.png", await picture(app.stage)))), video),
    el("p", { className: "soft small" }, Film.possible() ? "The scene as you see it. A video ends after 20 seconds." : "This browser cannot record video."),
  );
}
