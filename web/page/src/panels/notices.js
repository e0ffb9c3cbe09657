// Messages about events, with the actions that they offer; and questions.
import { $, el, say } from "../dom.js";
import { button } from "./controls.js";

/** Milliseconds that a message stays. Errors, and messages with actions, stay until they are closed. */
const STAY = 5000;

/** @param {import("../app.js").App} app */
export function notices(app) {
  const list = $("notices");
  const gone = (/** @type {string} */ name) => list.querySelectorAll(`[data-name="${CSS.escape(name)}"]`).forEach((box) => box.remove());
  app.on("notice", (/** @type {{ name: string } & import("../announce.js").Notice} */ { name, text, bad, stays, alert, actions = [] }) => {
    gone(name);
    while (list.children.length > 2) list.firstChild?.remove();
    const close = () => box.remove();
    const buttons = actions.map(([title, act], i) => button(title, () => {
      close();
      app.attempt(async () => void (await act()));
    }, i === 0 ? "main" : ""));
    const box = el("div", { className: bad ? "notice bad" : "notice" }, el("span", {}, text), alert ? null : button("Close", close, "tiny"), buttons.length ? el("div", { className: "actions" }, ...buttons) : null);
    box.dataset.name = name;
    if (alert) box.setAttribute("role", "alert");
    list.append(box);
    if (alert) {
      buttons[0]?.focus();
      hideVeil();
    }
    if (!bad && !stays) setTimeout(close, STAY);
  });
  app.on("over", gone);
  app.confirm = question;
}

/**
 * Asks a question with two answers; closing it means no.
 * @param {string} text
 * @param {string} yes
 * @param {string} no
 * @returns {Promise<boolean>}
 */
function question(text, yes, no) {
  return new Promise((resolve) => {
    const answer = (/** @type {string} */ value) => () => dialog.close(value);
    const dialog = el("dialog", { className: "question", "aria-label": text }, el("p", {}, text), el("div", { className: "row" }, button(yes, answer("yes"), "main"), button(no, answer("no"))));
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes");
    });
    document.body.append(dialog);
    dialog.showModal();
  });
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
 * Replaces the page by a message when it cannot continue.
 * @param {string} title
 * @param {string} text
 */
export function fatal(title, text) {
  document.body.append(el("div", { className: "fatal", role: "alert" }, el("div", {}, el("h1", {}, title), el("p", { className: "soft", style: "max-width:52ch;margin-top:10px" }, text))));
}
