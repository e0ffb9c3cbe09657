// The panel of things to watch: both eyes, the score of the behavior, the skin, signals over time.
import { el, say } from "../dom.js";
import { BEHAVIORS, capital, readable, TASKS } from "../names.js";
import { card, check } from "./controls.js";
import { signals } from "./signals.js";

/** @typedef {import("../types").Score} Score */

/** @param {import("../app.js").App} app */
export function watch(app) {
  return el("div", {}, eyes(app, "eyes", "What MIMo sees"), eyes(app, "second eyes", "What the second MIMo sees"), score(app), skin(app), signals(app));
}

/**
 * @param {import("../app.js").App} app
 * @param {"eyes" | "second eyes"} event
 * @param {string} title
 */
function eyes(app, event, title) {
  // the viewer faces MIMo, so his right eye is on the left
  const sides = ["right", "left"].map((side) => {
    const canvas = el("canvas", { width: 64, height: 64, role: "img", "aria-label": event === "eyes" ? `What the ${side} eye sees` : `What the second MIMo’s ${side} eye sees` });
    return { canvas, figure: el("figure", {}, canvas, el("figcaption", {}, `${capital(side)} eye`)) };
  });
  const note = el("p", { className: "soft small" });
  app.on(event, (/** @type {import("../types").Glance} */ { pixels, sizes, late }) => {
    say(note, [optics(event === "eyes" ? app.state.settings : (app.second.scene?.settings ?? {}), late), ...(plain(pixels) ? ["Nothing in sight but a plain surface, such as the ceiling over the crib."] : [])].filter(Boolean).join(". "));
    const [left, right] = sizes.map(([width, height]) => 4 * width * height);
    const pictures = [pixels.subarray(left, left + right), pixels.subarray(0, left)];
    sides.forEach(({ canvas }, i) => {
      const [width, height] = sizes[1 - i];
      if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
      canvas.getContext("2d")?.putImageData(new ImageData(pictures[i], width), 0, 0);
    });
  });
  const section = card(title, el("div", { className: "eyes" }, ...sides.map((s) => s.figure)), note);
  if (event !== "eyes") {
    section.hidden = true; // until a scene has a second MIMo
    app.on("scene", () => (section.hidden = !app.second.scene));
  }
  return section;
}

/** Smallest difference in brightness, of 255, from which a picture is not plain. */
const SOMETHING = 30;

/**
 * Returns whether a picture, RGBA, shows nothing.
 * @param {Uint8ClampedArray} pixels
 */
function plain(pixels) {
  let [least, most] = [255, 0];
  for (let i = 1; i < pixels.length; i += 4) {
    if (pixels[i] < least) least = pixels[i];
    if (pixels[i] > most) most = pixels[i];
  }
  return most - least < SOMETHING;
}

/**
 * Describes the transforms between the world and the eyes.
 * @param {import("../types").Settings} s
 * @param {number} late s
 */
function optics(s, late) {
  const said = [];
  if (s.vision_acuity) said.push(`as sharp as at ${s.age ?? 18} month${s.age === 1 ? "" : "s"}`);
  if (Number(s.vision_foveation) > 0) said.push("the middle enlarged");
  if (late > 0.0005) said.push(`${Math.round(1000 * late)} ms ago`);
  return capital(said.join(" · "));
}

/** @param {import("../app.js").App} app */
function score(app) {
  const number = el("strong", {}, "0");
  const unit = el("span", { className: "soft small" });
  const fill = el("i");
  const bar = el("div", { className: "bar", role: "progressbar", "aria-label": "Score", "aria-valuemin": 0, "aria-valuemax": 100 }, fill);
  const detail = el("div");
  const goal = el("p", { className: "small" });
  const section = card("Score so far", goal, el("div", { className: "value" }, number, unit), bar, detail);
  const heading = /** @type {HTMLElement} */ (section.querySelector("h2"));
  let drawn = "";
  app.on("tick", (/** @type {import("../types").Moment} */ moment) => {
    const s = moment.score;
    const what = s.earned === null ? "score so far" : "return so far";
    say(heading, s.behavior === "none" ? "Score" : `${TASKS[s.behavior]?.title ?? BEHAVIORS[s.behavior]}: ${what}`);
    say(goal, TASKS[s.behavior]?.goal ?? "");
    goal.hidden = !goal.textContent;
    const percent = s.value === null ? 0 : 100 * s.value;
    say(number, s.earned !== null ? s.earned.toFixed(1) : s.value === null ? "–" : `${percent.toFixed(1)} %`);
    fill.style.width = `${Math.min(100, percent)}%`;
    bar.setAttribute("aria-valuenow", percent.toFixed(0));
    bar.hidden = s.value === null;
    say(unit, caption(s, moment.truncated));
    const key = JSON.stringify([s.hands, s.regards, s.kit]);
    if (key !== drawn) {
      drawn = key;
      detail.replaceChildren(...(s.hands ? [hands(s.hands)] : s.regards ? [regards("by the camera's axis", s.regards, s.steps), ...(s.kit ? [regards("by the kit", s.kit, s.steps)] : [])] : []));
    }
  });
  return section;
}

/**
 * @param {Score} s
 * @param {boolean} truncated
 */
function caption(s, truncated) {
  const over = truncated ? " · episode complete" : "";
  if (s.earned !== null) return `${s.success ? "the goal is reached" : s.failure ? "the goal is out of reach" : "rewards of this episode"}${over}`;
  if (s.behavior === "self_touch") return `of the parts both palms can touch${over}`;
  if (s.behavior === "hand_regard") return `of the time, hands in view${over}`;
  return "Choose a behavior in Setup to count";
}

/** @param {NonNullable<Score["hands"]>} h */
function hands(h) {
  const side = (/** @type {string} */ title, /** @type {string[]} */ list) =>
    el("dl", {}, el("dt", {}, title), el("dd", {}, el("span", { className: "number" }, `${list.length} of ${h.reachable} parts`), el("div", { className: "parts" }, ...list.slice(-6).map((t) => el("span", {}, readable(t))))));
  return el("div", { className: "hands" }, side("Right palm", h.right), side("Left palm", h.left));
}

/**
 * @param {string} how the hands are counted
 * @param {NonNullable<Score["regards"]>} counts
 * @param {number} steps
 */
function regards(how, counts, steps) {
  const share = (/** @type {number} */ i) => el("td", {}, steps ? `${((100 * counts[i]) / steps).toFixed(1)} %` : "–");
  const head = el("tr", {}, el("th", { scope: "col" }, `In view, ${how}`), el("th", { scope: "col" }, "right hand"), el("th", { scope: "col" }, "left hand"));
  const row = (/** @type {string} */ eye, /** @type {number} */ i) => el("tr", {}, el("th", { scope: "row" }, eye), share(i), share(i + 1));
  return el("table", { className: "matrix" }, el("thead", {}, head), el("tbody", {}, row("Right eye", 0), row("Left eye", 2)));
}

/** @param {import("../app.js").App} app */
function skin(app) {
  const { stage } = app;
  /** Changes something on this stage and on the one next to it. */
  const each = (/** @type {(stage: import("../stage/stage.js").Stage) => void} */ change) => {
    for (const s of [stage, stage.peer]) {
      if (!s) continue;
      change(s);
      s.invalidate();
    }
  };
  const glow = check("Heat map of touch", (on) => each((s) => {
    if (s.skin) s.skin.visible = on && app.scene !== null && app.scene.skin.of.length > 0;
    s.glow = on;
  }), true);
  const dots = check("All sensors as dots", (on) => each((s) => {
    s.dots = on;
    if (s.skin) s.skin.dots = on;
  }), true);
  const arrows = check("Contact forces as arrows", (on) => {
    each((s) => (s.arrows.visible = on));
    if (!app.playing) app.world.tell("look");
  });
  const shadows = check("Shadows", (on) => each((s) => (s.studio.key.castShadow = on)), stage.studio.key.castShadow);
  const follow = check("Camera follows MIMo", (on) => {
    stage.orbit.follow = on;
  }, true);
  const count = el("p", { className: "soft small" });
  app.on("scene", (/** @type {import("../types").Scene} */ scene) => {
    const n = scene.skin.of.length;
    for (const box of [glow, dots]) box.hidden = n === 0;
    say(count, n ? `${n.toLocaleString("en")} sensors. Each glows with the force on it and fades when it ends.` : "This configuration has no sense of touch. Turn on touch_active in Setup.");
    follow.input.checked = stage.orbit.follow;
  });
  return card("In the scene", count, glow, dots, arrows, shadows, follow);
}
