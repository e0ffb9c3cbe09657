// The second MIMo: his picture, and what differs.
import { $, el, say } from "./dom.js";
import { unit } from "./delays.js";
import { POLICIES } from "./panels/move.js";
import { Pointer } from "./stage/pointer.js";
import { Stage } from "./stage/stage.js";

/** @typedef {import("./types").Scene} Scene */
/** @typedef {import("./types").Moment} Moment */

/** Checks of the pace, ten a second, after which a machine that is behind is too slow; and the share of the pace that is enough. */
const [LOOKS, ENOUGH] = [40, 0.85];

export class Second {
  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    /** @type {Stage | null} */
    this.stage = null;
    /** @type {Scene | null} */
    this.scene = null;
    this.shown = 0;
    /** A caption with his score on each infant's picture. */
    this.scores = [el("b"), el("b")];
    this.labels = this.scores.map(() => el("p", { className: "who glass" }));
    let behind = 0;
    app.on("tick", (/** @type {Moment} */ m) => {
      behind = this.scene && m.playing && m.pace < ENOUGH * Math.min(1, app.state.speed) ? behind + 1 : 0;
      this.count(0, m);
      if (behind === LOOKS) app.announce("slow", m.pace);
    });
    app.on("state", () => this.name());
  }

  /**
   * Shows a scene beside the first; null removes the picture.
   * @param {Scene | null} scene
   */
  show(scene) {
    this.scene = scene;
    if (!scene) return this.close();
    if (!this.stage) this.open();
    this.stage?.build(scene);
  }

  open() {
    const { app, labels } = this;
    const first = app.stage;
    const canvas = el("canvas", { id: "second", tabindex: 0, role: "application", "aria-label": "The second MIMo in his scene", "aria-describedby": "scene-keys" });
    first.canvas.after(canvas, ...labels);
    $("stage").classList.add("two");
    try {
      this.stage = new Stage(canvas, first.plain);
    } catch {
      this.close();
      app.announce("alone", "the browser has no graphics for a second picture.");
      return void app.attempt(() => app.compare(null)); // after this world, which has both
    }
    const { stage } = this;
    stage.pair(first);
    stage.theme = /** @type {"light" | "dark"} */ (document.documentElement.dataset.theme);
    stage.compile();
    new Pointer(stage, { pull: (p) => app.pull(p, true), release: () => app.letGo(true), mayPull: (b) => app.movable(b) });
    first.resize();
  }

  close() {
    $("stage").classList.remove("two");
    for (const label of this.labels) label.remove();
    if (!this.stage) return;
    this.stage.dispose();
    this.stage.canvas.remove();
    this.stage = null;
    this.app.stage.resize();
    this.app.stage.home();
  }

  /**
   * @param {Float32Array} frame
   * @param {Moment} moment
   */
  see(frame, moment) {
    const now = performance.now();
    this.stage?.show(frame, moment, moment.playing ? Math.min(0.1, (now - this.shown) / 1000) : 0.5);
    this.shown = now;
    this.count(1, moment);
  }

  /**
   * @param {0 | 1} which
   * @param {Moment} moment
   */
  count(which, { score: { value, earned } }) {
    say(this.scores[which], earned !== null ? `return ${earned.toFixed(1)}` : value !== null ? `${(100 * value).toFixed(1)} %` : "");
  }

  /** Labels each picture with its infant. */
  name() {
    const { app, scene } = this;
    const { twin, policy } = app.state;
    if (!twin || !scene || !app.scene) return;
    [app.scene, scene].forEach(({ settings: s, timestep }, i) => {
      const late = ["sensory", "motor"].map((what) => [what, Math.round(unit(s, timestep) * Number(s[`delay_${what}`] ?? 0))]).filter(([, ms]) => ms);
      const moved = POLICIES.find(([value]) => value === (i ? twin.policy : policy))?.[1] ?? "";
      this.labels[i].replaceChildren(typeof s.age === "number" ? `${s.age} months` : "Original size", el("span", {}, ["", moved, ...late.map(([what, ms]) => `${what} delay ${ms} ms`)].join(" · ")), this.scores[i]);
    });
  }
}
