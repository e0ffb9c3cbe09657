// The second MIMo next to the first, and his own settings.
import { el, say } from "../dom.js";
import { POLICIES } from "./move.js";
import { card, check, slider } from "./controls.js";

/** Initial settings of the second MIMo: another age. @type {import("../types").Twin} */
const FIRST = { age: 3, policy: "babbling", sensory: 0, motor: 0 };
/** The age of the original's proportions, months. */
const ORIGINAL = 18;

/** @param {import("../app.js").App} app */
export function compare(app) {
  const error = el("p", { className: "error", role: "alert" });
  const change = async (/** @type {import("../types").Twin | null} */ twin) => {
    say(error, "");
    try {
      await app.compare(twin);
    } catch (e) {
      say(error, /** @type {Error} */ (e).message);
    }
    app.emit("state");
  };
  const own = (/** @type {Partial<import("../types").Twin>} */ what) => change({ ...FIRST, ...app.state.twin, ...what });
  const on = check("A second MIMo beside him", (wanted) => change(wanted ? { ...FIRST, policy: app.state.policy } : null));
  const line = (/** @type {string} */ text, /** @type {"age" | "sensory" | "motor"} */ key, /** @type {number} */ max, /** @type {number} */ step, /** @type {string} */ unit) => {
    const made = slider(text, { min: 0, max, step, value: 0, format: (v) => `${v}${unit}`, label: `${text} of the second` }, () => {});
    made.input.addEventListener("change", () => own({ [key]: made.input.valueAsNumber }));
    app.on("state", () => made.set(app.state.twin?.[key] ?? (key === "age" ? ORIGINAL : 0)));
    return made;
  };
  const policy = el("select", { "aria-label": "What moves the second", onchange: () => own({ policy: /** @type {import("../types").PolicyName} */ (policy.value) }) });
  const rest = el("div", { style: "display:grid;gap:12px" }, line("Months", "age", 24, 0.5, ""), policy, line("Sensory delay", "sensory", 400, 5, " ms"), line("Motor delay", "motor", 400, 5, " ms"));
  app.on("state", () => {
    const { twin } = app.state;
    on.input.checked = Boolean(twin);
    rest.hidden = !twin;
    policy.replaceChildren(...POLICIES.map(([value, text]) => el("option", { value, selected: value === twin?.policy, disabled: value === "model" && !app.model }, text)));
  });
  return card("Side by side", on, el("p", { className: "soft small" }, "Both begin together, from the same seed, and one clock moves them. Everything else is as above."), rest, error);
}
