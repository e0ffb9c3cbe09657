// The small parts that panels are made of.
import { el } from "../dom.js";

let made = 0;

/**
 * @param {string} title
 * @param {...(Node | null)} children
 */
export function card(title, ...children) {
  return el("section", { className: "card" }, el("header", {}, el("h2", {}, title)), ...children);
}

/**
 * A row of buttons with one chosen.
 * @param {string} label
 * @param {[string, string][]} options value and text
 * @param {(value: string) => void} chosen
 */
export function choice(label, options, chosen) {
  const name = `choice-${made++}`;
  const inputs = options.map(([value]) => el("input", { type: "radio", name, value, onchange: () => chosen(value) }));
  const root = el(
    "fieldset",
    { className: "choice" },
    el("legend", { className: "hidden" }, label),
    ...options.map(([, text], i) => el("label", {}, inputs[i], text)),
  );
  return Object.assign(root, {
    /** @param {string} value */
    set(value) {
      for (const input of inputs) input.checked = input.value === value;
    },
  });
}

/**
 * @param {string} text
 * @param {(on: boolean) => void} changed
 * @param {boolean} [checked]
 */
export function check(text, changed, checked = false) {
  const input = el("input", { type: "checkbox", checked, onchange: () => changed(input.checked) });
  return Object.assign(el("label", { className: "check" }, input, el("span", {}, text)), { input });
}

/**
 * A row with a name, a slider and its value.
 * @param {string} text
 * @param {{ min: number, max: number, step?: number | "any", value: number, format?: (v: number) => string, label?: string }} options
 * @param {(value: number) => void} moved
 */
export function slider(text, { min, max, step = "any", value, format = (v) => v.toFixed(2), label = text }, moved) {
  const input = el("input", { type: "range", min, max, step, value, "aria-label": label });
  const output = el("span", { className: "reading" }, format(value));
  const say = () => {
    const read = format(input.valueAsNumber);
    if (output.textContent === read) return;
    output.textContent = read;
    input.setAttribute("aria-valuetext", read);
  };
  // a range without steps does not listen to arrow keys finely enough
  input.addEventListener("keydown", (e) => {
    if (step !== "any" || !e.key.startsWith("Arrow")) return;
    e.preventDefault();
    const way = e.key === "ArrowRight" || e.key === "ArrowUp" ? 1 : -1;
    input.valueAsNumber += (way * (max - min)) / (e.shiftKey ? 10 : 40);
    input.dispatchEvent(new Event("input"));
  });
  input.addEventListener("input", () => {
    say();
    moved(input.valueAsNumber);
  });
  input.setAttribute("aria-valuetext", format(value));
  const root = el("div", { className: "slider" }, el("span", { title: text }, text), input, output);
  return Object.assign(root, {
    input,
    /** @param {number} v */
    set(v) {
      if (document.activeElement === input && root.classList.contains("held")) return;
      input.valueAsNumber = v;
      say();
    },
  });
}

/**
 * A place to drop or choose one or several files.
 * @param {string} text
 * @param {string} accept
 * @param {(file: File, all: File[]) => void} taken
 * @param {Partial<HTMLInputElement>} [more] of its field
 */
export function drop(text, accept, taken, more = {}) {
  const input = el("input", { type: "file", accept, className: "hidden", "aria-label": text, ...more, onchange: () => {
    const files = Array.from(input.files ?? []);
    input.value = "";
    if (files.length) taken(files[0], files);
  } });
  const root = el("label", { className: "drop" }, input, text);
  return Object.assign(root, { input });
}

/**
 * @param {string} text
 * @param {() => void} pressed
 * @param {string} [className]
 */
export function button(text, pressed, className = "") {
  return el("button", { className: `button ${className}`, type: "button", onclick: pressed }, text);
}
