// The timeline: back through the last half minute, or through a recording that plays, and on from there.
import { $ } from "../dom.js";

/** Seconds by which the arrow keys move, and Page Up and Page Down. */
const [ARROW, PAGE] = [0.1, 2];

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -ARROW, ArrowDown: -ARROW, ArrowRight: ARROW, ArrowUp: ARROW, PageDown: -PAGE, PageUp: PAGE };

/** @typedef {import("../types").Moment} Moment */

/**
 * Shows the current moment; empty in the present.
 * @param {Moment} moment
 * @param {number} seconds of a step
 * @param {number} [at] where, in steps
 */
export function where({ line }, seconds, at = line.at) {
  if (line.recording) return `${(at * seconds).toFixed(1)} of ${(line.to * seconds).toFixed(1)}`;
  return at < line.to ? ((line.to - at) * seconds).toFixed(1) : "";
}

/** @param {import("../app.js").App} app */
export function past(app) {
  const line = /** @type {HTMLInputElement} */ ($("past"));
  /** The moment to which time is moving, if it was requested. */
  /** @type {number | null} */
  let goal = null;
  let asked = 0;
  const seconds = () => app.scene?.timestep ?? 0;
  const words = (/** @type {Moment} */ m, /** @type {number} */ at) => {
    const text = where(m, seconds(), at);
    return m.line.recording ? `${text} seconds of the recording` : text ? `${text} seconds ago` : "now";
  };
  const shown = (/** @type {Moment} */ m) => {
    const { from, to, at } = m.line;
    const now = goal ?? at;
    Object.assign(line, { min: Math.min(from, to - 1), max: to, value: now, disabled: m.recorded !== null || to <= from });
    line.style.setProperty("--at", `${to > from ? (100 * (now - from)) / (to - from) : 100}%`);
    // screen readers announce the moment when time is paused, not ten times a second
    if (!m.playing || !m.line.recording) line.setAttribute("aria-valuetext", m.playing && now < to ? "in the past" : words(m, now));
  };
  const go = (/** @type {number} */ to) => {
    const m = app.moment;
    if (!m || line.disabled) return;
    goal = Math.min(m.line.to, Math.max(m.line.from, Math.round(to)));
    shown({ ...m, playing: false });
    asked++;
    app.attempt(() => app.seek(/** @type {number} */ (goal))).finally(() => {
      if (--asked === 0) goal = null;
    });
  };
  line.addEventListener("input", () => go(line.valueAsNumber));
  line.addEventListener("keydown", (e) => {
    if (!(e.key in KEYS) || e.ctrlKey || e.metaKey || e.altKey || !app.moment) return;
    e.preventDefault();
    go((goal ?? app.moment.line.at) + KEYS[e.key] / seconds());
  });
  app.on("tick", shown);
  return { back: () => app.moment && go((goal ?? app.moment.line.at) - 1) };
}
