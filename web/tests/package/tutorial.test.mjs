// The tutorial "MIMo in a page of your own": its page, as readers save it, beside the package.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { test } from "node:test";
import { launch, noChromium } from "../launch.mjs";
import { root, serve } from "./server.mjs";

test("the page of the tutorial shows MIMo and counts what he touches", { skip: noChromium }, async () => {
  const text = readFileSync(join(root, "docs/tutorials/page.md"), "utf8");
  const page = /^```html\n(.*?)^```$/ms.exec(text)?.[1];
  assert.ok(page, "the tutorial has a page");
  const folder = mkdtempSync(join(root, "web/dist/tutorial-"));
  cpSync(join(root, "web/dist/babybench"), join(folder, "babybench"), { recursive: true });
  writeFileSync(join(folder, "index.html"), page);
  const browser = await launch();
  const server = await serve();
  try {
    const tab = await browser.newPage();
    /** @type {string[]} */
    const errors = [];
    tab.on("pageerror", (/** @type {Error} */ error) => errors.push(String(error)));
    await tab.goto(String(new URL(`/web/dist/${basename(folder)}/index.html`, server.page)));
    await tab.waitForFunction(() => /^step \d+: \d+ parts touched$/.test(document.querySelector("#felt")?.textContent ?? ""), undefined, { timeout: 60_000 });
    const { shades, restarted } = await tab.evaluate(async () => {
      const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
      const { data } = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d")).getImageData(0, 0, canvas.width, canvas.height);
      const step = () => Number(/\d+/.exec(document.querySelector("#felt")?.textContent ?? "")?.[0]);
      const before = step();
      /** @type {HTMLButtonElement} */ (document.querySelector("#again")).click();
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      return { shades: new Set(data).size, restarted: step() <= before + 8 };
    });
    assert.deepEqual(errors, []);
    assert.ok(shades > 20, "the canvas shows a scene");
    assert.ok(restarted);
  } finally {
    await browser.close();
    server.close();
    rmSync(folder, { recursive: true });
  }
});
