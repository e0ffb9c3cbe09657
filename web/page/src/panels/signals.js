// Signals over the last seconds: those that users pick, each in a strip of its own.
import { el, say } from "../dom.js";
import { readable } from "../names.js";
import { card } from "./controls.js";

/** @typedef {import("../types").Scene} Scene */
/** @typedef {{ key: string, title: string, unit: string, read: (f: Float32Array, s: Scene) => number }} Signal */

/** Seconds that a strip shows. */
const SPAN = 10;
/** Samples that it keeps. */
const KEPT = 600;
const COLORS = ["#0a6fbd", "#c2410c", "#15803d", "#9333ea", "#be185d", "#0f766e"];
const AXES = ["forward", "left", "up"];
const MOST = 6;

/**
 * @param {Scene} scene
 * @returns {{ group: string, signals: Signal[] }[]}
 */
function available(scene) {
  const l = scene.layout;
  const own = scene.joints.map((j, i) => ({ j, i })).filter(({ j }) => j.part !== null);
  const degrees = 180 / Math.PI;
  return [
    {
      group: "Whole body",
      signals: [
        ...(scene.skin.of.length
          ? [{ key: "touch", title: "Total touch", unit: "N", read: (/** @type {Float32Array} */ f) => f.subarray(l.felt, l.worn).reduce((a, b) => a + b, 0) }]
          : []),
        ...AXES.map((a, k) => ({ key: `acceleration ${k}`, title: `Head acceleration, ${a}`, unit: "m/s²", read: (/** @type {Float32Array} */ f) => f[l.balance + k] })),
        ...AXES.map((a, k) => ({ key: `rotation ${k}`, title: `Head rotation about ${a}`, unit: "rad/s", read: (/** @type {Float32Array} */ f) => f[l.balance + 3 + k] })),
      ],
    },
    { group: "Joint angles", signals: own.map(({ j, i }) => ({ key: `angle ${j.name}`, title: readable(j.name), unit: "°", read: (f) => degrees * f[l.angles + i] })) },
    { group: "Joint torques", signals: own.map(({ j, i }) => ({ key: `torque ${j.name}`, title: `${readable(j.name)}, torque`, unit: "N m", read: (f) => f[l.torques + i] })) },
  ];
}

/** One strip: a ring of samples and its drawing. */
class Strip {
  /**
   * @param {Signal} signal
   * @param {string} color
   * @param {() => void} close
   */
  constructor(signal, color, close) {
    this.signal = signal;
    this.color = color;
    this.times = new Float64Array(KEPT);
    this.values = new Float64Array(KEPT);
    this.count = 0;
    this.canvas = el("canvas", { role: "img", "aria-label": `${signal.title} over the last ${SPAN} seconds` });
    this.output = el("span", { className: "reading" });
    const swatch = el("span", { className: "swatch", "aria-hidden": "true" });
    swatch.style.background = color;
    const x = el("button", { "aria-label": `Remove ${signal.title}`, title: "Remove", onclick: close }, "✕");
    this.root = el("div", { className: "plot" }, el("header", {}, swatch, el("span", {}, signal.title), this.output, x), this.canvas);
  }

  /**
   * @param {number} time
   * @param {number} value
   */
  add(time, value) {
    const last = this.times[(this.count - 1 + KEPT) % KEPT];
    if (this.count && time < last) this.count = 0;
    if (this.count && time === last) return;
    this.times[this.count % KEPT] = time;
    this.values[this.count % KEPT] = value;
    this.count++;
  }

  /** @param {{ line: string, text: string }} ink */
  draw(ink) {
    const { canvas } = this;
    const scale = Math.min(devicePixelRatio, 2);
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w) return;
    if (canvas.width !== Math.round(w * scale)) [canvas.width, canvas.height] = [Math.round(w * scale), Math.round(h * scale)];
    const c = canvas.getContext("2d");
    if (!c) return;
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, w, h);
    const first = Math.max(0, this.count - KEPT);
    const now = this.count ? this.times[(this.count - 1) % KEPT] : 0;
    let [low, high] = [Infinity, -Infinity];
    for (let i = first; i < this.count; i++) {
      if (this.times[i % KEPT] < now - SPAN) continue;
      low = Math.min(low, this.values[i % KEPT]);
      high = Math.max(high, this.values[i % KEPT]);
    }
    if (!(low <= high)) [low, high] = [0, 1];
    const least = Math.max(1e-3, 0.02 * Math.max(Math.abs(low), Math.abs(high)));
    if (high - low < least) [low, high] = [low - least, high + least];
    const [left, y] = [38, (/** @type {number} */ v) => 5 + ((high - v) / (high - low)) * (h - 10)];
    c.font = "10.5px Inter, sans-serif";
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const v of [low, high]) {
      c.strokeStyle = ink.line;
      c.lineWidth = 1;
      c.beginPath();
      c.moveTo(left, y(v));
      c.lineTo(w, y(v));
      c.stroke();
      c.fillStyle = ink.text;
      c.fillText(short(v), left - 6, y(v));
    }
    c.strokeStyle = this.color;
    c.lineWidth = 1.6;
    c.lineJoin = "round";
    c.beginPath();
    let open = false;
    for (let i = first; i < this.count; i++) {
      const t = this.times[i % KEPT];
      if (t < now - SPAN) continue;
      const x = left + (1 - (now - t) / SPAN) * (w - left - 2);
      if (open) c.lineTo(x, y(this.values[i % KEPT]));
      else c.moveTo(x, y(this.values[i % KEPT]));
      open = true;
    }
    c.stroke();
    say(this.output, this.count ? `${short(this.values[(this.count - 1) % KEPT])} ${this.signal.unit}` : "");
  }
}

/** @param {number} v */
function short(v) {
  const size = Math.abs(v);
  return (size >= 100 ? v.toFixed(0) : size >= 10 ? v.toFixed(1) : v.toFixed(2)).replace("-", "−");
}

/** @param {import("../app.js").App} app */
export function signals(app) {
  /** @type {Map<string, Signal>} */
  const known = new Map();
  /** @type {Map<string, Strip>} */
  const strips = new Map();
  const list = el("div", { style: "display:grid;gap:12px" });
  const select = el("select", { "aria-label": "Add a signal", onchange: () => {
    if (select.value) add(select.value);
    select.value = "";
  } });
  const note = el("p", { className: "soft small" }, "Pick a signal to see it over the last ten seconds.");

  /** @param {string} key */
  function add(key) {
    const signal = known.get(key);
    if (!signal || strips.has(key)) return;
    if (strips.size >= MOST) return app.notice(`${MOST} signals fit. Remove one first.`);
    const used = [...strips.values()].map((s) => s.color);
    const color = COLORS.find((c) => !used.includes(c)) ?? COLORS[0];
    const strip = new Strip(signal, color, () => {
      strips.delete(key);
      strip.root.remove();
      note.hidden = strips.size > 0;
      select.focus();
    });
    strips.set(key, strip);
    list.append(strip.root);
    note.hidden = true;
  }

  app.on("scene", (/** @type {Scene} */ scene) => {
    known.clear();
    const groups = available(scene);
    for (const g of groups) for (const s of g.signals) known.set(s.key, s);
    select.replaceChildren(
      el("option", { value: "" }, "Add a signal …"),
      ...groups.map((g) => el("optgroup", { label: g.group }, ...g.signals.map((s) => el("option", { value: s.key }, s.title)))),
    );
    const kept = [...strips.keys()].filter((k) => known.has(k));
    strips.clear();
    list.replaceChildren();
    for (const key of kept.length ? kept : ["touch", "angle robot:right_elbow"]) add(key);
  });
  app.on("play", (/** @type {import("../types").Moment} */ moment) => {
    if (app.scene) for (const s of strips.values()) s.add(moment.time, s.signal.read(app.frame, app.scene));
  });
  app.on("tick", () => {
    const style = getComputedStyle(document.documentElement);
    const ink = { line: style.getPropertyValue("--line"), text: style.getPropertyValue("--soft") };
    for (const s of strips.values()) s.draw(ink);
  });
  return card("Signals", note, list, select);
}
