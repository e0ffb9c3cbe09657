// Tabs, as the ARIA practices describe them: one stop of the tab key, arrows between them.
import { $, el } from "../dom.js";
import { kept } from "../storage.js";

/**
 * @param {Record<string, HTMLElement>} panels by title
 * @param {(title: string) => void} shown
 */
export function tabs(panels, shown) {
  const bar = $("tabs");
  const titles = Object.keys(panels);
  const buttons = titles.map((title) => {
    const id = title.toLowerCase();
    const button = el("button", { id: `tab-${id}`, role: "tab", "aria-controls": `panel-${id}` }, title);
    button.addEventListener("click", () => choose(title));
    const panel = panels[title];
    panel.id = `panel-${id}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", button.id);
    return button;
  });
  /** Scroll position of each tab: the panel scrolls, or the page on phones. */
  /** @type {Map<string, [number, number]>} */
  const read = new Map();
  /** @param {string} title */
  function choose(title) {
    const before = titles.find((t) => !panels[t].hidden);
    const room = $("panels");
    if (before) read.set(before, [room.scrollTop, scrollY]);
    titles.forEach((t, i) => {
      const on = t === title;
      buttons[i].setAttribute("aria-selected", String(on));
      buttons[i].tabIndex = on ? 0 : -1;
      panels[t].hidden = !on;
    });
    const [inside, page] = read.get(title) ?? [0, 0];
    if (title !== before) {
      room.scrollTop = inside;
      scrollTo({ top: page, behavior: "instant" });
    }
    kept("tab", title);
    shown(title);
  }
  bar.addEventListener("keydown", (e) => {
    const now = titles.findIndex((_, i) => buttons[i].getAttribute("aria-selected") === "true");
    /** @type {Record<string, number>} */
    const next = { ArrowRight: now + 1, ArrowLeft: now - 1, Home: 0, End: titles.length - 1 };
    if (!(e.key in next)) return;
    e.preventDefault();
    const i = (next[e.key] + titles.length) % titles.length;
    choose(titles[i]);
    buttons[i].focus();
  });
  bar.append(...buttons);
  $("panels").append(...Object.values(panels));
  for (const t of titles) panels[t].hidden = true;
  choose(titles.find((t) => t === kept("tab")) ?? titles[0]);
  return choose;
}
