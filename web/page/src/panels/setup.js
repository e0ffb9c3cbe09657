// The configuration: scene, behavior, body, muscles, senses, seed; and every key of the file, from the library's own table.
import { download, el, say } from "../dom.js";
import { BEHAVIORS, capital, TASKS } from "../names.js";
import { readRoom, sceneOf } from "../room.js";
import { MOST_SEED } from "../state.js";
import { compare } from "./compare.js";
import { button, card, check, choice, drop, slider } from "./controls.js";
import { senses } from "./senses.js";

/** @typedef {import("../types").Key} Key */
/** @typedef {import("../types").Scene} Scene */
/** @typedef {import("../types").Setting} Setting */

/** @type {[string, string][]} */
const SCENES = [["crib", "Crib"], ["cubes", "Cubes"], ["base", "Floor"], ["mobile", "Mobile"], ["playroom", "Play room"], ["blanket", "Blanket"]];
/** @type {[string, string][]} */
const BODIES = [["v1", "Mitten hands (v1)"], ["v2", "Five fingers (v2)"]];
/** @type {[string, string][]} */
const VERSIONS = [["2", "MIMo 2"], ["3", "MIMo 3"]];
/** @type {[string, string][]} */
const ACTUATION = [["spring_damper", "Torque"], ["muscle", "Muscles"], ["positional", "Angles"]];

/** @type {[string, string][]} */
const FACES = [["default", "Calm"], ["happy", "Happy"], ["sad", "Sad"], ["surprised", "Surprised"], ["angry", "Angry"], ["disgusted", "Disgusted"], ["scared", "Scared"]];

/** The age whose proportions are nearest to the original's, months. */
const ORIGINAL = 18;

/** @param {import("../app.js").App} app */
export function setup(app) {
  return el("div", {}, presets(app), scene(app), room(app), senses(app), compare(app), start(app), file(app), all(app));
}

/** Presets: names, and the settings that differ from those of a first visit. @type {[string, import("../types").Settings][]} */
const PRESETS = [
  ["A newborn’s eyes", { behavior: "hand_regard", scene: "cubes", age: 0, vision_active: true, vision_acuity: true }],
  ["Three months, in the crib", { behavior: "self_touch", scene: "crib", age: 3 }],
  ["Hands in sight", { behavior: "hand_regard", scene: "crib", vision_active: true }],
  ["A ball to reach", { behavior: "reach" }],
];

/** @param {import("../app.js").App} app */
function presets(app) {
  const begin = (/** @type {import("../types").Settings} */ settings) => app.attempt(() => app.begin({ vision_active: false, max_episode_steps: 12_000, ...settings }));
  return card("Begin with", el("div", { className: "row" }, ...PRESETS.map(([title, settings]) => button(title, () => begin(settings)))));
}

/** @param {import("../app.js").App} app */
function scene(app) {
  const error = el("p", { className: "error", role: "alert" });
  const attempt = async (/** @type {() => Promise<unknown>} */ work) => {
    say(error, "");
    try {
      await work();
    } catch (e) {
      say(error, /** @type {Error} */ (e).message);
      app.emit("state");
    }
  };
  const change = (/** @type {import("../types").Settings} */ settings) => attempt(() => app.change(settings));
  const places = choice("Scene", SCENES, (v) => change({ scene: v }));
  const isTask = (/** @type {unknown} */ name) => String(name) in TASKS;
  const choose = (/** @type {string} */ v) => {
    const { behavior, age, mimo_version } = app.settings;
    // settings of another task would conflict with the defaults of this one
    const kept = { behavior: v, age, mimo_version, vision_active: false, max_episode_steps: 12_000 };
    if (isTask(v)) attempt(() => app.begin(kept));
    else if (isTask(behavior)) attempt(() => app.begin({ ...kept, scene: "crib" }));
    else change({ behavior: v });
  };
  const behaviors = choice("Behavior", Object.entries(BEHAVIORS), choose);
  const task = el("select", { "aria-label": "Task", onchange: () => choose(task.value || "self_touch") }, el("option", { value: "" }, "None"), ...Object.entries(TASKS).map(([value, { title }]) => el("option", { value }, title)));
  const bodies = choice("Body", BODIES, (v) => change({ behavior: v === "v2" ? "hand_regard" : "self_touch" }));
  const versions = choice("Version", VERSIONS, (v) => change({ mimo_version: Number(v) }));
  const actuation = choice("Actuation", ACTUATION, (v) => change({ actuation_model: v }));
  const original = button("Original", () => change({ age: null }), "tiny");
  const age = slider("Months", { min: 0, max: 24, step: 0.5, value: ORIGINAL, format: String, label: "Age of the body" }, () => {});
  age.input.addEventListener("change", () => change({ age: age.input.valueAsNumber }));
  const face = el("select", { "aria-label": "Face", onchange: () => attempt(() => app.face(face.value)) }, ...FACES.map(([value, text]) => el("option", { value }, text)));
  app.on("state", () => {
    const s = app.settings;
    face.value = String(s.facial_expression ?? "default");
    age.set(typeof s.age === "number" ? s.age : ORIGINAL);
    original.disabled = typeof s.age !== "number";
    for (const part of [place, body]) part.hidden = isTask(s.behavior);
    places.set(String(s.scene));
    behaviors.set(String(s.behavior));
    task.value = isTask(s.behavior) ? String(s.behavior) : "";
    bodies.set(s.behavior === "hand_regard" ? "v2" : "v1");
    versions.set(String(s.mimo_version ?? 2));
    actuation.set(String(s.actuation_model));
  });
  const goal = el("p", { className: "small" });
  app.on("state", () => {
    say(goal, TASKS[String(app.settings.behavior)]?.goal ?? "");
    goal.hidden = !goal.textContent;
  });
  const line = (/** @type {string} */ title, /** @type {HTMLElement} */ control, /** @type {string} */ hint) =>
    el("div", { style: "display:grid;gap:5px" }, el("div", { className: "small" }, title), control, hint ? el("p", { className: "soft small" }, hint) : null);
  const place = line("Scene", places, "");
  const body = line("Body", bodies, "Hand regard has the body with fingers, the other behaviors the one with mittens.");
  return card(
    "World",
    line("Behavior", behaviors, ""),
    line("Task", task, "A task has a goal, a reward, and a scene and a body of its own."),
    goal,
    place,
    body,
    line("Version", versions, "The chest of MIMo 3 has two joints of its own."),
    line("Growth", el("div", { className: "age" }, age, original), "Size, mass and strength at an age. The original is measured as a child of 18 months."),
    line("Face", face, "At any moment; nothing else changes."),
    line("Actuation", actuation, "Torques, pairs of opposing muscles, or desired angles."),
    error,
  );
}

/** @param {import("../app.js").App} app */
function room(app) {
  const error = el("p", { className: "error", role: "alert" });
  const take = async (/** @type {File[]} */ files) => {
    say(error, "");
    try {
      await app.enter(await readRoom(files));
    } catch (e) {
      say(error, /** @type {Error} */ (e).message);
    }
  };
  const place = drop("Drop a room here: its folder, a .zip, or its files", ".xml,.zip,.yml,.yaml,image/*", (_, files) => take(files), { multiple: true });
  const folder = drop("Choose a folder", "", (_, files) => take(files), { webkitdirectory: true });
  folder.className = "button";
  const list = el("select", { "aria-label": "Room", onchange: () => app.attempt(() => app.change({ scene: list.value })) });
  app.on("state", () => {
    const scenes = app.room?.scenes ?? [];
    list.hidden = scenes.length === 0;
    const now = sceneOf(app.settings) ?? "";
    list.replaceChildren(...["", ...scenes].map((value) => el("option", { value, selected: value === now, disabled: value === "" }, value || "Scenes of this room")));
  });
  return card(
    "A room of your own",
    el("p", { className: "soft small" }, "An MJCF document in which MIMo is included beside furniture and toys, with its pictures. No server sees it; a link that you copy holds it if it is small."),
    place,
    el("div", { className: "row" }, folder, el("a", { className: "button", href: "./room.xml", download: "my_room.xml" }, "Save one to start from")),
    list,
    error,
  );
}

/** @param {import("../app.js").App} app */
function start(app) {
  const seed = el("input", { type: "number", min: 0, max: MOST_SEED, step: 1, value: 0, "aria-label": "Seed" });
  const read = () => Math.min(MOST_SEED, Math.max(0, Math.floor(seed.valueAsNumber) || 0));
  const again = () => app.attempt(() => app.reset(read()));
  seed.addEventListener("change", again);
  app.on("state", () => {
    if (document.activeElement !== seed) seed.valueAsNumber = app.state.seed;
  });
  const next = button("Next seed", () => {
    seed.valueAsNumber = read() + 1;
    again();
  });
  const revive = button("Start the simulation again", () => app.attempt(() => app.revive()), "tiny");
  seed.style.width = "112px";
  return card("Start", el("div", { className: "row" }, seed, button("Reset", again), next), el("p", { className: "soft small" }, "Equal seeds give equal runs, here and in every other build of the library."), el("div", {}, revive));
}

/** @param {import("../app.js").App} app */
function file(app) {
  const text = el("textarea", { spellcheck: false, "aria-label": "Configuration as YAML" });
  const error = el("p", { className: "error", role: "alert" });
  const use = async () => {
    say(error, "");
    try {
      app.state.locks = [];
      if (await app.make({}, null, text.value)) app.notice("The configuration is in use.");
    } catch (e) {
      say(error, /** @type {Error} */ (e).message);
    }
  };
  app.on("scene", (/** @type {Scene} */ s) => {
    text.value = s.yaml;
    say(error, "");
  });
  const save = button("Save file", () => download("babybench.yml", new Blob([text.value], { type: "text/yaml" })));
  const place = drop("Drop a configuration (.yml) here, or choose one", ".yml,.yaml", async (f) => {
    text.value = await f.text();
    details.open = true;
    use();
  });
  const details = el("details", { className: "part" }, el("summary", {}, "As a file"), el("div", {}, text, error, el("div", { className: "row", style: "margin-top:8px" }, button("Use", use, "main"), save)));
  return card("Configuration", place, details);
}

/** @param {import("../app.js").App} app */
function all(app) {
  const list = el("div", { className: "keys" });
  const error = el("p", { className: "error", role: "alert" });
  let filled = false;
  /** @type {Map<string, (value: Setting) => void>} */
  const fields = new Map();
  const set = async (/** @type {string} */ name, /** @type {Setting} */ value) => {
    say(error, "");
    try {
      await app.change({ [name]: value });
    } catch (e) {
      say(error, /** @type {Error} */ (e).message);
      refresh();
    }
  };
  const refresh = () => {
    for (const [name, show] of fields) show(app.settings[name]);
  };
  const details = el("details", { className: "part" }, el("summary", {}, "Every setting"), el("div", {}, error, list));
  details.addEventListener("toggle", async () => {
    if (!details.open || filled) return refresh();
    filled = true;
    /** @type {Key[]} */
    const keys = await app.world.ask("keys");
    let section = "";
    for (const key of keys) {
      if (key.section !== section) list.append(el("h3", {}, (section = key.section)));
      const made = field(key, (v) => set(key.name, v));
      fields.set(key.name, made.show);
      list.append(made.root);
    }
    refresh();
  });
  app.on("state", refresh);
  return card("Advanced", details);
}

/**
 * @param {Key} key
 * @param {(value: Setting) => void} changed
 * @returns {{ root: HTMLElement, show: (value: Setting) => void }}
 */
function field(key, changed) {
  if (key.kind === "boolean") {
    const box = check(key.name, changed);
    return { root: el("div", {}, box, el("p", { className: "soft small" }, key.doc)), show: (v) => (box.input.checked = v === true) };
  }
  if (key.kind === "list") {
    const chosen = () => {
      const names = boxes.filter((box) => box.input.checked).map((box) => String(box.textContent));
      return names.length === 0 && key.default === null ? null : names;
    };
    const boxes = (key.options ?? []).map((name) => check(name, () => changed(chosen())));
    const hint = el("p", { className: "soft small" }, capital(key.doc));
    return { root: el("fieldset", { className: "plain" }, el("legend", {}, key.name), ...boxes, hint), show: (v) => boxes.forEach((box) => (box.input.checked = Array.isArray(v) && v.includes(String(box.textContent)))) };
  }
  const id = `key-${key.name}`;
  const hint = el("small", {}, capital(key.doc));
  if (key.options) {
    const select = el("select", { id, onchange: () => changed(select.value) }, ...key.options.map((c) => el("option", { value: c }, c)));
    return { root: el("div", { className: "field" }, el("label", { htmlFor: id }, key.name), select, hint), show: (v) => {
      // a custom room is not one of the options
      select.value = String(v);
      if (select.value !== String(v)) select.append(el("option", { value: v, selected: true }, String(v)));
    } };
  }
  const number = key.kind !== "text";
  const input = el("input", { id, type: number ? "number" : "text", step: "any", min: key.min, max: key.max });
  const none = (/** @type {string} */ text) => text === "" && key.default === null;
  input.addEventListener("change", () => changed(none(input.value) ? null : number ? input.valueAsNumber : input.value));
  return { root: el("div", { className: "field" }, el("label", { htmlFor: id }, key.name), input, hint), show: (v) => (input.value = String(v ?? "")) };
}
