// Messages: what happened, in words, with what one can do about it.
import { $, el, say } from "../dom.js";
import { button } from "./controls.js";

/** Milliseconds that a message stays. Errors stay until they are closed. */
const STAY = 5000;

/** @param {import("../app.js").App} app */
export function notices(app) {
  const list = $("notices");
  app.on("notice", ({ text, bad }) => {
    for (const old of list.children) if (old.firstChild?.textContent === text) old.remove();
    while (list.children.length > 2) list.firstChild?.remove();
    const box = el("div", { className: bad ? "notice bad" : "notice" }, el("span", {}, text), button("Close", () => box.remove(), "tiny"));
    list.append(box);
    if (!bad) setTimeout(() => box.remove(), STAY);
  });
  app.on("fault", (/** @type {string} */ why) => {
    list.replaceChildren();
    const again = button("Start again", () => {
      box.remove();
      app.attempt(() => app.revive());
    }, "main");
    const box = el("div", { className: "notice bad", role: "alert" }, el("span", {}, `The simulation has stopped: ${explain(why)}`), el("div", { className: "actions" }, again));
    list.append(box);
    again.focus();
    app.setPlaying(false);
    hideVeil();
  });
}

/** @param {string} why */
function explain(why) {
  if (/^ModuleError/.test(why)) return why.replace(/^ModuleError: (the simulation stopped: )?/, "");
  if (/memory|allocation|grow/i.test(why)) return `the browser gave it no more memory (${why}). Close other tabs, or choose a smaller scene.`;
  if (/unreachable|RuntimeError/.test(why)) return `an internal error (${why}). Your settings are kept.`;
  return why;
}

/** @param {string} text */
export function veil(text) {
  say($("veil-text"), text);
  $("veil").classList.remove("gone");
}

export function hideVeil() {
  $("veil").classList.add("gone");
}

/**
 * Replaces the page by a message: nothing can go on.
 * @param {string} title
 * @param {string} text
 */
export function fatal(title, text) {
  document.body.append(el("div", { className: "fatal", role: "alert" }, el("div", {}, el("h1", {}, title), el("p", { className: "soft", style: "max-width:52ch;margin-top:10px" }, text))));
}
