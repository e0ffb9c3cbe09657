// Time: play, one step, reset, speed, the clock; and their keys.
import { $, el, say } from "../dom.js";
import { SPEEDS } from "../state.js";
import { past, where } from "./past.js";


/** @param {import("../app.js").App} app */
export function transport(app) {
  const play = $("play");
  const speed = /** @type {HTMLSelectElement} */ ($("speed"));
  const clock = $("clock");
  speed.append(...SPEEDS.map((value) => el("option", { value, selected: value === 1 }, `${value} ×`)));
  const { back } = past(app);
  const toggle = () => app.attempt(() => app.play(!app.playing));
  const step = () => {
    app.play(false);
    app.attempt(() => app.world.ask("step", 1));
  };
  const reset = () => app.attempt(() => app.reset());
  play.addEventListener("click", toggle);
  $("step").addEventListener("click", step);
  $("reset").addEventListener("click", reset);
  speed.addEventListener("change", () => {
    app.state.speed = Number(speed.value);
    app.move();
  });
  app.on("state", () => {
    play.setAttribute("aria-pressed", String(app.playing));
    play.setAttribute("aria-label", app.playing ? "Pause" : "Play");
    speed.value = String(app.state.speed);
  });
  app.on("tick", (/** @type {import("../types").Moment} */ m) => {
    const ago = where(m, app.scene?.timestep ?? 0);
    const told = m.line.recording ? `${ago} s recorded` : ago ? `${ago} s ago` : m.playing ? `${m.pace.toFixed(2)} × real time` : "";
    clock.replaceChildren(`${m.time.toFixed(2)} s`, ...(told ? [el("small", { className: ago ? "ago" : "" }, told)] : []));
  });
  document.addEventListener("keydown", (e) => {
    const on = /** @type {HTMLElement} */ (e.target);
    if (e.ctrlKey || e.metaKey || e.altKey || (on.id !== "past" && on.closest("input, select, textarea, dialog"))) return;
    const pressable = on.closest("button, a, summary");
    if (e.key === " " && !pressable) toggle();
    else if (e.key === ".") step();
    else if (e.key === ",") back();
    else if (e.key === "r" || e.key === "R") reset();
    else if (e.key === "?") $("help-open").click();
    else return;
    e.preventDefault();
  });
}

/** @param {import("../app.js").App} app */
export function caption(app) {
  /** @type {Record<string, string>} */
  const scenes = { crib: "in its crib", cubes: "among cubes", base: "on the floor", mobile: "below a mobile", playroom: "among toys", blanket: "under a blanket" };
  app.on("scene", (/** @type {import("../types").Scene} */ s) => {
    const name = String(s.settings.scene);
    say($("where"), `A virtual infant ${scenes[name] ?? `in ${name.replace(/^.*\/|\.xml$/gi, "").replaceAll("_", " ")}`}: skin, eyes and muscles, alive`);
  });
}
