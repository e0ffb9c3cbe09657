// The panel that moves MIMo: a policy, sliders that hold joints, locks, the spring of the pointer.
import { el, say } from "../dom.js";
import { PARTS, capital, readable, split } from "../names.js";
import { button, card, choice, drop, slider } from "./controls.js";
import { trained } from "./trained.js";

/** @typedef {import("../types").Scene} Scene */
/** @typedef {import("../types").PolicyName} PolicyName */

/** @type {[PolicyName, string][]} */
export const POLICIES = [["babbling", "Babbling"], ["random", "Random"], ["sine", "Sine"], ["zero", "Still"], ["model", "Model"]];
/** @type {Record<PolicyName, string>} */
const MEANINGS = {
  babbling: "Smooth random efforts, each joint in a rhythm of its own, as infants babble with their limbs.",
  random: "A new random action in every step: the random policy of BabyBench, with NumPy's numbers.",
  sine: "Every joint swings, each a little later than its neighbour.",
  zero: "No effort. Gravity, contacts and your sliders remain.",
  model: "A trained network decides. It sees what BabyBench lets policies see.",
};

/** @param {import("../app.js").App} app */
export function move(app) {
  return el("div", {}, policies(app), trained(app), pulling(app), sliders(app));
}

/** @param {import("../app.js").App} app */
function policies(app) {
  const meaning = el("p", { className: "soft small" });
  const vigour = slider("Vigour", { min: 0, max: 1, value: app.state.vigour, format: (v) => `${Math.round(100 * v)} %` }, (v) => {
    app.state.vigour = v;
    app.move();
  });
  const model = drop("Drop an ONNX model here, or choose one", ".onnx", (file) => {
    app.attempt(async () => app.bring({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), url: null }));
  });
  const pick = choice("What moves MIMo", POLICIES, (value) => {
    const { model: network } = app;
    if (value === "model") {
      if (network) return void app.attempt(() => app.bring(network)).then((brought) => brought || app.emit("state"));
      pick.set(app.state.policy); // until there is one
      model.hidden = false;
      return model.input.focus();
    }
    app.state.policy = /** @type {PolicyName} */ (value);
    app.move();
  });
  app.on("state", () => {
    pick.set(app.state.policy);
    say(meaning, `${app.moment?.replay ? "A recording plays; after it: " : ""}${app.state.policy === "model" && app.model ? `${app.model.name}: ` : ""}${MEANINGS[app.state.policy]}`);
    vigour.hidden = app.state.policy !== "babbling" && app.state.policy !== "sine";
    vigour.set(app.state.vigour);
    model.hidden = app.state.policy !== "model";
  });
  return card("Policy", pick, meaning, vigour, model);
}

/** @param {import("../app.js").App} app */
function pulling(app) {
  const strength = slider("Strength", { min: 4, max: 30, step: 1, value: 12, format: (v) => `${(v / 12).toFixed(1)} ×` }, (v) => app.world.tell("strength", v));
  const which = el("select", { "aria-label": "Part to pull" });
  const up = button("Pull up", () => {
    const held = up.getAttribute("aria-pressed") !== "true";
    up.setAttribute("aria-pressed", String(held));
    up.classList.toggle("on", held);
    say(up, held ? "Let go" : "Pull up");
    if (!held) return app.letGo();
    const body = Number(which.value);
    const at = app.stage.bodyPoses.subarray(7 * body, 7 * body + 3);
    app.pull({ body, point: [0, 0, 0], target: [at[0], at[1], at[2] + 0.3] });
  });
  up.setAttribute("aria-pressed", "false");
  const force = el("span", { className: "soft small number" });
  app.on("scene", (/** @type {Scene} */ scene) => {
    const own = scene.bodies.map((b, i) => ({ ...b, i })).filter((b) => b.mass > 0 && b.i > 0 && b.movable);
    const before = own.find((b) => b.name === "right_hand")?.i ?? own[0]?.i;
    which.replaceChildren(...own.map((b) => el("option", { value: b.i, selected: b.i === before }, readable(b.name))));
  });
  app.on("tick", (/** @type {import("../types").Moment} */ m) => {
    const taken = m.recorded !== null || m.replay !== null;
    up.disabled = taken;
    say(force, m.pull ? `${m.pull.force.toFixed(1)} N` : taken ? "waits until the recording ends" : "");
    if (!m.pull && up.getAttribute("aria-pressed") === "true" && !app.held) {
      up.setAttribute("aria-pressed", "false");
      up.classList.remove("on");
      say(up, "Pull up");
    }
  });
  return card(
    "Pull",
    el("p", { className: "soft small" }, "Drag any part in the scene. The heavier the part, the stiffer the spring."),
    strength,
    el("div", { className: "row" }, which, up, force),
  );
}

/** @param {import("../app.js").App} app */
function sliders(app) {
  const groups = el("div", { style: "display:grid;gap:8px" });
  const free = button("Let all go", () => {
    app.state.held = {};
    app.move();
  }, "tiny");
  const section = card("Joints", el("p", { className: "soft small" }, "Sliders show what the policy does. Move one and it holds; Delete or a double click lets it go."), groups);
  section.querySelector("header")?.append(free);
  /** @type {{ index: number, row: ReturnType<typeof slider> }[]} */
  let rows = [];
  /** @type {(() => void)[]} */
  let marks = [];

  app.on("scene", (/** @type {Scene} */ scene) => {
    const open = new Set([...groups.querySelectorAll("details[open]")].map((d) => d.id));
    rows = [];
    marks = [];
    groups.replaceChildren(...Object.entries(PARTS).map(([part, title]) => group(scene, part, title, open)).filter((g) => g !== null));
  });
  app.on("state", () => {
    for (const { index, row } of rows) row.classList.toggle("held", index in app.state.held);
    for (const mark of marks) mark();
    free.hidden = Object.keys(app.state.held).length === 0;
  });
  app.on("tick", () => {
    if (!section.offsetParent || !app.scene) return;
    const at = app.scene.layout.action;
    for (const { index, row } of rows) if (/** @type {HTMLDetailsElement} */ (row.closest("details")).open) row.set(app.frame[at + index]);
  });

  /**
   * @param {Scene} scene
   * @param {string} part
   * @param {string} title
   * @param {Set<string>} open
   */
  function group(scene, part, title, open) {
    const actions = scene.actions.map((a, index) => ({ ...a, index })).filter((a) => a.part === part);
    const joints = scene.joints.filter((j) => j.part === part);
    if (!actions.length && !joints.length) return null;
    const body = el("div");
    for (const side of /** @type {const} */ (["", "right", "left"])) {
      const own = actions.filter((a) => split(a.name).side === side);
      if (side && own.length) body.append(el("div", { className: "side" }, capital(side)));
      for (const a of own) body.append(line(a));
    }
    if (!actions.length) body.append(el("p", { className: "soft small" }, `No actuators here. Turn on act_${part} in Setup.`));
    const lock = button("Lock", () => app.attempt(() => app.lock(part, joints.some((j) => !j.locked))), "tiny");
    const state = el("span", { className: "soft" });
    marks.push(() => {
      const now = joints.filter((j) => j.locked).length;
      say(lock, now < joints.length ? "Lock" : "Unlock");
      lock.classList.toggle("on", joints.length > 0 && now === joints.length);
      lock.setAttribute("aria-label", `${now < joints.length ? "Lock" : "Unlock"} ${title.toLowerCase()}`);
      const held = actions.filter((a) => a.index in app.state.held).length;
      say(state, [held ? `${held} held` : "", now ? `${now} of ${joints.length} locked` : `${actions.length} actuators`].filter(Boolean).join(" · "));
    });
    body.append(el("div", { className: "row", style: "margin-top:8px" }, lock, el("span", { className: "soft small" }, "holds the joints where they are")));
    const details = el("details", { className: "part", id: `part-${part}`, open: open.has(`part-${part}`) || (open.size === 0 && part === "arms") }, el("summary", {}, title, state), body);
    return details;
  }

  /** @param {{ name: string, low: number, high: number, index: number }} a */
  function line(a) {
    const row = slider(capital(split(a.name).what), { min: a.low, max: a.high, value: 0, label: readable(a.name) }, (v) => {
      app.state.held[a.index] = v;
      app.move();
    });
    const release = () => {
      delete app.state.held[a.index];
      app.move();
    };
    row.input.addEventListener("dblclick", release);
    row.input.addEventListener("keydown", (e) => {
      if (e.key === "Delete" || e.key === "Backspace") release();
    });
    rows.push({ index: a.index, row });
    return row;
  }
  return section;
}
