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

test("nothing that changes by itself is read out", async () => {
  const page = await host.open({ query: "" });
  await until(page, () => mimo.moment.steps > 20);
  for (const name of TABS) {
    await tab(page, name);
    const live = await page.evaluate(async () => {
      const changed = new Set();
      const watch = new MutationObserver((all) => all.forEach(({ target }) => changed.add((target.nodeType === 1 ? target : target.parentElement).closest("output, [role=status], [role=log], [role=alert], [aria-live=polite], [aria-live=assertive]"))));
      watch.observe(document.body, { childList: true, characterData: true, subtree: true });
      await new Promise((done) => setTimeout(done, 1200));
      watch.disconnect();
      return [...changed].filter(Boolean).map((e) => e.outerHTML.slice(0, 90));
    });
    assert.deepEqual(live, [], name);
  }
  await page.context().close();
});

test("with the system's colours the chosen tab, the chosen option and the track of a slider can be told", async () => {
  const page = await host.open({ forcedColors: "active" });
  await tab(page, "Setup");
  const colours = await page.evaluate(() => {
    const of = (e) => getComputedStyle(e).backgroundColor;
    const pair = (all, on) => [of(all.find(on)), of(all.find((e) => !on(e)))];
    const labels = [...document.querySelectorAll("#panel-setup .choice label")];
    return [pair([...document.querySelectorAll("[role=tab]")], (t) => t.ariaSelected === "true"), pair(labels, (l) => l.querySelector(":checked"))];
  });
  for (const [on, off] of colours) assert.notEqual(on, off);
  const slider = page.getByLabel("Age of the body");
  await slider.scrollIntoViewIfNeeded();
  const picture = await slider.screenshot();
  const seen = await page.evaluate(async (data) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const c = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    c.drawImage(bitmap, 0, 0);
    const at = (y) => c.getImageData(8, y, 1, 1).data.join();
    return at(Math.floor(bitmap.height / 2)) !== at(2);
  }, picture.toString("base64"));
  assert.ok(seen, "the track is drawn");
  await page.context().close();
});

for (const [width, height, what] of [[320, 640, "320 pixels"], [320, 256, "400 % zoom"]]) {
  test(`at ${what} nothing is cut off or covered`, async () => {
    const page = await host.open({ width, height, query: "" });
    await until(page, () => mimo.moment.steps > 5);
    const found = await page.evaluate(() => {
      const box = (s) => document.querySelector(s).getBoundingClientRect();
      const [play, transport, mast, clock, stage, past] = ["#play", ".transport", ".masthead h1", "#clock", ".stage", "#past"].map(box);
      return { past: past.width, wide: document.scrollingElement.scrollWidth, round: play.width - play.height, apart: transport.top - mast.bottom, clock: transport.right - clock.right, stage: stage.height };
    });
    assert.ok(found.wide <= width, `${found.wide} wide`);
    assert.ok(Math.abs(found.round) < 1, "the button is round");
    assert.ok(found.past > 200, `a line of time of ${found.past}`);
    assert.ok(found.apart > 0 && found.clock >= 0, JSON.stringify(found));
    assert.ok(found.stage >= 200, `a scene of ${found.stage}`);
    await page.context().close();
  });
}

test("every target is at least 24 pixels large, or has as much room", async () => {
  const page = await host.open();
  await page.evaluate(axe);
  const findings = [];
  for (const name of TABS) {
    await tab(page, name);
    await page.evaluate(() => document.querySelectorAll("#panels details").forEach((d) => (d.open = true)));
    await page.waitForTimeout(400);
    const { violations } = await page.evaluate(() => axe.run({ runOnly: ["target-size"] }));
    findings.push(...violations.flatMap((v) => v.nodes.map((n) => `${name}: ${n.target}`)));
  }
  assert.deepEqual(findings, []);
  await page.context().close();
});
