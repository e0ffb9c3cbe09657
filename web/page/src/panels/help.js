// "What am I seeing?"
import { $, el, say } from "../dom.js";
import { TASKS } from "../names.js";
import { button } from "./controls.js";

const link = (/** @type {string} */ href, /** @type {string} */ text) => el("a", { href, rel: "noopener", target: "_blank" }, text);

/** @param {import("../app.js").App} app */
export function help(app) {
  const dialog = /** @type {HTMLDialogElement} */ ($("help"));
  const size = el("p", {});
  app.on("state", () => {
    const { age } = app.settings;
    say(size, typeof age === "number" ? `Here he is as large, heavy and strong as at ${age} month${age === 1 ? "" : "s"}.` : "Here he has his original size, that of a child of about 18 months; the tab Setup has other ages, from birth to two years.");
  });
  const close = button("Close", () => dialog.close(), "close tiny");
  dialog.append(
    close,
    el("h2", { id: "help-title" }, "What am I seeing?"),
    size,
    el("p", {}, "MIMo is a model of an infant, built to ask how a mind begins: what can be learned from one’s own body, before words, tasks or rewards? Everything here is computed in this tab, 200 times a simulated second: joints, muscles, contacts, skin, balance and what the eyes see."),
    el("h3", {}, "The skin"),
    el("p", {}, "Thousands of sensors cover the body, dense on the fingertips and sparse on the back. Each reports the force on it. The heat map shows these forces on a logarithmic scale, from a tenth of a newton to ten. What lies hidden under the body shines through faintly."),
    el("h3", {}, "The eyes"),
    el("p", {}, "Both eyes move and see in colour. The pictures beside the scene are what MIMo sees, drawn by the library itself, pixel by pixel as a learning program receives them."),
    el("h3", {}, "The score"),
    el("p", {}, "BabyBench asks for two behaviors that infants discover on their own. MIMo is not rewarded for them; a score only counts them."),
    el("ul", {},
      el("li", {}, "Self-touch: how many parts of the body have the palms found, of all they can reach?"),
      el("li", {}, "Hand regard: how much of the time is a hand in the centre of an eye’s view?")),
    el("p", {}, "Beside them are tasks of MIMo’s own, with a goal and a reward:"),
    el("ul", {}, ...Object.values(TASKS).map(({ title, goal }) => el("li", {}, `${title}: ${goal}`))),
    el("h3", {}, "What you can do"),
    el("ul", {},
      el("li", {}, "Drag any part: a spring pulls it. Drag beside MIMo to turn, scroll or pinch to come closer, hold Shift to move."),
      el("li", {}, "Take over single joints with sliders, lock others, or drop a trained network (ONNX) on the page."),
      el("li", {}, "Go back through the last half minute on the timeline. From there the same happens again, bit by bit, until you do something else."),
      el("li", {}, "Put a second MIMo beside him, of another age, with other nerves or another policy: one clock moves both."),
      el("li", {}, "Send a link: it carries this very moment, and continues with the same bits on another machine.")),
    el("p", { style: "margin-top:10px" }, el("kbd", {}, "Space"), " play or pause  ", el("kbd", {}, "."), " one step  ", el("kbd", {}, ","), " one back  ", el("kbd", {}, "R"), " reset  ", el("kbd", {}, "?"), " this panel"),
    el("h3", {}, "Read on"),
    el("ul", {},
      el("li", {}, link("https://doi.org/10.1109/ICDL53763.2022.9962192", "Mattern, López, Ernst, Aubret and Triesch: MIMo, a multi-modal infant model for studying cognitive development in humans and AIs"), " (ICDL 2022)"),
      el("li", {}, link("https://arxiv.org/abs/2312.04318", "Mattern, Schumacher, López, Raabe, Ernst, Aubret and Triesch: MIMo, a multi-modal infant model for studying cognitive development"), " (IEEE TCDS 2024)"),
      el("li", {}, link("https://babybench.github.io/2025", "BabyBench: the competition at IEEE ICDL 2025")),
    ),
  );
  dialog.addEventListener("click", (e) => {
    if (e.target === dialog) dialog.close();
  });
  $("help-open").addEventListener("click", () => dialog.showModal());
  return () => dialog.showModal();
}
