// Senses that mature: how sharply the eyes see and where, and how late MIMo senses and acts.
import { inMilliseconds, unit as unitOf } from "../delays.js";
import { el, say } from "../dom.js";
import { card, check, slider } from "./controls.js";

/** @typedef {import("../types").Settings} Settings */

/** @param {import("../app.js").App} app */
export function senses(app) {
  const error = el("p", { className: "error", role: "alert" });
  let last = Promise.resolve();
  /** Queue of changes; each starts from the result of the previous one. */
  const change = (/** @type {() => Settings} */ settings) => {
    last = last.then(async () => {
      say(error, "");
      try {
        await app.change(settings());
      } catch (e) {
        say(error, /** @type {Error} */ (e).message);
        app.emit("state");
      }
    });
  };
  return card("Senses", ...eyes(app, change), ...delays(app, change), error);
}

/**
 * @param {import("../app.js").App} app
 * @param {(settings: () => Settings) => void} change
 */
function eyes(app, change) {
  /** Whether vision is on only for these two. */
  let lent = false;
  const see = (/** @type {Settings} */ settings) => change(() => {
    const { vision_active, vision_acuity, vision_foveation } = { ...app.settings, ...settings };
    const needed = vision_acuity === true || Number(vision_foveation) > 0;
    if (needed && !vision_active) lent = true;
    return { ...settings, vision_active: needed || (vision_active === true && !lent) };
  });
  const acuity = check("Eyes as sharp as at MIMo’s age", (on) => see({ vision_acuity: on }));
  const foveation = slider("Foveation", { min: 0, max: 20, step: 1, value: 0, format: (v) => (v > 0 ? String(v) : "off") }, () => {});
  foveation.input.addEventListener("change", () => see({ vision_foveation: foveation.input.valueAsNumber }));
  app.on("state", () => {
    const s = app.settings;
    acuity.input.checked = s.vision_acuity === true;
    foveation.set(Number(s.vision_foveation) || 0);
    if (s.vision_active !== true) lent = false;
  });
  const hint = "A newborn sees a blur, and the middle of an eye sees more than its edge. Both show in the tab Watch; the original MIMo counts as 18 months old.";
  return [acuity, foveation, el("p", { className: "soft small" }, hint)];
}

/**
 * @param {import("../app.js").App} app
 * @param {(settings: () => Settings) => void} change
 */
function delays(app, change) {
  const unit = () => unitOf(app.settings, app.scene?.timestep);
  const set = (/** @type {string} */ key, /** @type {number} */ ms) => change(() => ({ ...inMilliseconds(app.settings, app.scene?.timestep), [key]: ms, ...(key === "delay_sensory" && ms > 0 && { delay_by_age: false }) }));
  const line = (/** @type {string} */ text, /** @type {string} */ key, /** @type {string} */ label) => {
    const made = slider(text, { min: 0, max: 400, step: 5, value: 0, format: (v) => `${Math.round(v)} ms`, label }, () => {});
    made.input.addEventListener("change", () => set(key, made.input.valueAsNumber));
    app.on("state", () => made.set(unit() * (Number(app.settings[key]) || 0)));
    return made;
  };
  const hint = "Nerves take time: what MIMo senses, and what he does, comes this much later.";
  return [line("Sensory delay", "delay_sensory", "Delay of the senses"), line("Motor delay", "delay_motor", "Delay of movement"), el("p", { className: "soft small" }, hint)];
}
