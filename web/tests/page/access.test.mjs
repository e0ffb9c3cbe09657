// The page without a mouse, and to those who do not see it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { start, tab, until } from "./browser.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const TABS = ["Watch", "Move", "Setup", "Share"];
let host;
before(async () => (host = await start()));
after(() => host.stop());

for (const scheme of ["light", "dark"]) {
  test(`axe has no serious finding (${scheme})`, async () => {
    const page = await host.open({ scheme });
    await page.evaluate(axe);
    const findings = [];
    for (const name of [...TABS, "What am I seeing?"]) {
      if (TABS.includes(name)) await tab(page, name);
      else await page.getByRole("button", { name }).click();
      await page.evaluate(() => document.querySelectorAll("#panels details").forEach((d) => (d.open = true)));
      await page.waitForTimeout(400);
      const { violations } = await page.evaluate(() => axe.run());
      const serious = violations.filter((v) => v.impact === "serious" || v.impact === "critical");
      findings.push(...serious.map((v) => `${name}: ${v.id} at ${v.nodes.map((n) => n.target).join(", ")}`));
    }
    assert.deepEqual(findings, []);
    await page.context().close();
  });
}

test("on a wide screen only the panel scrolls, never the page", async () => {
  const page = await host.open();
  for (const name of TABS) {
    await tab(page, name);
    await page.evaluate(() => document.querySelectorAll("#panels details").forEach((d) => (d.open = true)));
    await page.waitForTimeout(300);
    const [all, shown] = await page.evaluate(() => [document.scrollingElement.scrollHeight, document.scrollingElement.clientHeight]);
    assert.equal(all, shown, name);
  }
  await page.context().close();
});

test("every control is reached by the tab key, in every tab", async () => {
  const page = await host.open();
  for (const name of TABS) {
    await tab(page, name);
    await page.evaluate(() => document.querySelectorAll("#panels details").forEach((d) => (d.open = true)));
    await page.waitForTimeout(300);
    const wanted = await page.evaluate(() => {
      // of radio buttons with one name the tab key stops at one, of tabs at the chosen one
      const all = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, canvas[tabindex]")];
      const seen = new Set();
      return all.filter((e) => {
        if (e.disabled || !e.checkVisibility() || e.closest("dialog, .notice") || (e.getAttribute("role") === "tab" && e.tabIndex < 0)) return false;
        if (e.type !== "radio") return true;
        const first = !seen.has(e.name);
        seen.add(e.name);
        return first;
      }).map((e, i) => (e.dataset.stop = e.type === "radio" ? e.name : String(i)));
    });
    await page.evaluate(() => document.activeElement?.blur());
    const reached = new Set();
    for (let i = 0; i < wanted.length + 20; i++) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => {
        const e = document.activeElement;
        return e?.type === "radio" ? e.name : (e?.dataset.stop ?? "");
      }));
    }
    const missed = wanted.filter((w) => !reached.has(w));
    const names = await page.evaluate((m) => m.map((s) => document.querySelector(`[data-stop="${s}"]`)?.outerHTML.slice(0, 90)), missed);
    assert.deepEqual(names, [], `${name}: not reached`);
    console.log(`${name}: ${wanted.length} controls, all reached`);
    await page.evaluate(() => document.querySelectorAll("[data-stop]").forEach((e) => delete e.dataset.stop));
  }
  await page.context().close();
});

test("keys play, step, reset, turn the view and open the help", async () => {
  const page = await host.open();
  await page.locator("#scene").focus();
  await page.keyboard.press(".");
  await until(page, () => mimo.moment.steps === 1);
  await page.keyboard.press(" ");
  await until(page, () => mimo.moment.steps > 5);
  await page.keyboard.press(" ");
  await until(page, () => !mimo.moment.playing);
  await page.keyboard.press("r");
  await until(page, () => mimo.moment.steps === 0);
  const azimuth = await page.evaluate(() => mimo.stage.orbit.azimuth);
  await page.keyboard.press("ArrowLeft");
  assert.notEqual(await page.evaluate(() => mimo.stage.orbit.azimuth), azimuth);
  await page.keyboard.press("?");
  assert.ok(await page.locator("#help").isVisible());
  await page.keyboard.press("Escape");
  assert.ok(!(await page.locator("#help").isVisible()));
  await page.context().close();
});

test("with reduced motion nothing starts by itself", async () => {
  const page = await host.open({ query: "", reducedMotion: "reduce" });
  await page.waitForTimeout(500);
  assert.equal(await page.evaluate(() => mimo.playing), false);
  assert.equal(await page.evaluate(() => mimo.moment.steps), 0);
  await page.context().close();
});

test("each tab has its own place to read on", async () => {
  const page = await host.open();
  await tab(page, "Setup");
  await page.evaluate(() => (document.getElementById("panels").scrollTop = 300));
  await tab(page, "Share");
  assert.equal(await page.evaluate(() => document.getElementById("panels").scrollTop), 0);
  await tab(page, "Setup");
  assert.equal(await page.evaluate(() => document.getElementById("panels").scrollTop), 300);
  await page.context().close();
});
