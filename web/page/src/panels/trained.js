// Policies trained for MIMo's tasks, in separate files of the page. Each starts its task and moves him.
import { el } from "../dom.js";
import { button, card } from "./controls.js";

/** Its action, its task, its file, and MIMo's age if it is not 18 months. @type {[string, string, string, number?][]} */
export const TRAINED = [
  ["Reaches for the ball", "reach", "policies/reach.onnx"],
  ["Touches a part of himself", "selfbody", "policies/selfbody.onnx"],
  ["Stands up", "standup", "policies/standup.onnx"],
  ["Rolls over", "roll_over", "policies/roll_over.onnx"],
  ["Rolls over at 9 months", "roll_over", "policies/roll_over_9.onnx", 9],
  ["Rolls over at 6 months", "roll_over", "policies/roll_over_6.onnx", 6],
  ["Catches the ball", "catch", "policies/catch.onnx"],
];

/** @param {import("../app.js").App} app */
export function trained(app) {
  const buttons = TRAINED.map(([title, behavior, url, age]) => {
    const start = button(title, () => app.attempt(() => begin(app, behavior, url, age)));
    app.on("state", () => {
      const on = app.state.policy === "model" && app.model?.url === url;
      start.classList.toggle("on", on);
      start.setAttribute("aria-pressed", String(on));
    });
    return start;
  });
  return card("Trained", el("p", { className: "soft small" }, "Networks that have each learned a task. A button starts the task, in its own scene and with its own body; “Next seed” in Setup sets another goal."), el("div", { className: "row" }, ...buttons));
}

/**
 * @param {import("../app.js").App} app
 * @param {string} behavior
 * @param {string} url
 * @param {number} [age]
 */
async function begin(app, behavior, url, age) {
  const bytes = await app.sharing.fetched(url, (answer) => answer.arrayBuffer());
  if (!bytes) return;
  const { policy } = app.state;
  app.state.policy = "zero"; // the network that is there was made for another task
  if (!(await app.begin({ behavior, vision_active: false, ...(age && { age }) }))) {
    app.state.policy = policy;
    return;
  }
  await app.bring({ name: url.replace(/.*\//, ""), bytes: new Uint8Array(bytes), url });
  app.play(true);
}
