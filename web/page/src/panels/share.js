// The panel for sharing: a link, a recording, a picture, a video.
import { seconds } from "../announce.js";
import { download, el, say } from "../dom.js";
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
      const { href, lacks } = await app.sharing.made(moment);
      app.sharing.show(href, moment);
      shown.hidden = false;
      say(shown, href.length > 400 ? `${href.slice(0, 380)}…` : href);
      shown.dataset.href = href;
      try {
        await navigator.clipboard.writeText(href);
        app.notice(`The link is in the clipboard. ${lacks}`, lacks !== "");
      } catch {
        app.notice(`The link is in the address bar. ${lacks}`, lacks !== "");
      }
    });
  return card(
    "Link",
    el("p", { className: "soft small" }, "Everything is in the link; no server keeps it. When opened, this moment continues with the same bits."),
    el("div", { className: "row" }, button("Copy link to this moment", () => copy(true), "main"), button("Link to the settings", () => copy(false))),
    shown,
  );
}

/** @param {import("../app.js").App} app */
function tape(app) {
  /** @type {import("../types").Recording | null} */
  let last = null;
  const state = el("p", { className: "soft small" });
  const record = button("Record", () =>
    app.attempt(async () => {
      if (app.moment?.recorded != null) return app.recordings.end();
      await app.world.ask("record");
      app.play(true);
    }),
  );
  const save = button("Save .npz", () => last && download("recording.npz", toFile(last)));
  const config = button("Save its configuration", () => app.scene && download("babybench.yml", new Blob([app.scene.yaml], { type: "text/yaml" })));
  const again = button("Replay", () => app.attempt(() => last ? app.recordings.replay(last) : undefined));
  save.disabled = again.disabled = true;
  const command = "babybench replay --config babybench.yml --recording recording.npz --compat api --out replay";
  app.on("tick", (/** @type {import("../types").Moment} */ m) => {
    const on = m.recorded !== null;
    say(record, on ? "Stop" : "Record");
    record.classList.toggle("recording", on);
    if (m.replay) say(state, `Replaying ${seconds(app, m.replay.done)} of ${seconds(app, m.replay.of)}`);
    else if (on) say(state, `Recording: ${seconds(app, m.recorded ?? 0)}. Pulling and locking wait until it ends, because a recording holds only actions.`);
    else say(state, last ? `Recorded ${seconds(app, last.steps)}, ${last.steps} steps.` : "A recording starts a new episode from this very pose.");
  });
  app.on("tape", (/** @type {{ recording: import("../types").Recording }} */ { recording }) => {
    last = recording;
    save.disabled = again.disabled = false;
    if (app.moment) app.emit("tick", app.moment);
  });
  return card(
    "Recording",
    state,
    el("div", { className: "row" }, record, again, save, config),
    drop("Drop a recording (.npz) here to replay it", ".npz", (f) => app.attempt(async () => app.recordings.replay(await fromFile(new Uint8Array(await f.arrayBuffer()))))),
    el("p", { className: "soft small" }, "On the command line the same bits come from"),
    el("code", { className: "block" }, command),
  );
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
    el("p", { className: "soft small" }, Film.possible() ? "The scene as you see it; of two MIMos the first. A video ends after 20 seconds." : "This browser cannot record video."),
  );
}
