// Errors are reported in words, and the page goes on.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

/** Opens the tab Setup with its file. */
async function file(page, text) {
  await tab(page, "Setup");
  await page.getByText("As a file").click();
  await page.getByLabel("Configuration as YAML").fill(text);
  await page.getByRole("button", { name: "Use", exact: true }).click();
}

test("an error of the configuration names key and place, and the world goes on", async () => {
  const page = await host.open();
  await file(page, "scene: crib\nbehaviour: self_touch\n");
  const error = page.getByRole("alert").filter({ hasText: "behaviour" });
  await error.waitFor();
  assert.match(await error.innerText(), /line 2|:2/);
  assert.match(await error.innerText(), /behavior/);
  await steps(page, 3);
  assert.equal(await page.evaluate(() => mimo.moment.steps), 3);
  await page.context().close();
});

test("a value out of range is refused with its key", async () => {
  const page = await host.open();
  const message = await page.evaluate(() => mimo.change({ vision_resolution: 0, vision_active: true }).then(() => "", (e) => e.message));
  assert.match(message, /vision_resolution/);
  assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "crib");
  await page.context().close();
});

test("when the worker dies the page says so and starts again", async () => {
  const page = await host.open();
  await steps(page, 5);
  await page.evaluate(() => mimo.world.die("RuntimeError: unreachable"));
  await page.getByText("The simulation has stopped").waitFor();
  await page.getByRole("button", { name: "Start again" }).click();
  await until(page, () => mimo.world.alive && mimo.moment.steps === 0);
  await steps(page, 2);
  assert.equal(await page.evaluate(() => mimo.moment.steps), 2);
  await page.context().close();
});

test("a worker that cannot be loaded is reported", async () => {
  const context = await host.browser.newContext();
  await context.route("**/worker.js", (route) => route.abort());
  const page = await context.newPage();
  await page.goto(`${host.url}?paused`);
  await page.getByText("The simulation has stopped").waitFor();
  await context.close();
});

test("without WebGL the page says what to do", async () => {
  const page = await host.open({ wait: false, before: () => (HTMLCanvasElement.prototype.getContext = () => null) });
  await page.getByRole("heading", { name: "WebGL is missing" }).waitFor();
  await page.context().close();
});

test("without WebAssembly the page says what to do", async () => {
  const page = await host.open({ wait: false, before: () => delete globalThis.WebAssembly });
  await page.getByRole("heading", { name: "WebAssembly is missing" }).waitFor();
  await page.context().close();
});

test("memory that runs out stops the world with a message, not the tab", async () => {
  const page = await host.open();
  await page.evaluate(() => mimo.world.die("RangeError: WebAssembly.Memory.grow(): Maximum memory size exceeded"));
  await page.getByText("the browser gave it no more memory").waitFor();
  assert.equal(await page.evaluate(() => 1 + 1), 2);
  await page.context().close();
});

test("files of other kinds are refused in words", async () => {
  const page = await host.open();
  await tab(page, "Share");
  await page.locator("#panel-share input[type=file]").setInputFiles({ name: "notes.npz", mimeType: "application/zip", buffer: Buffer.from("no archive") });
  await page.getByText("The file is not a NumPy archive").waitFor();
  await page.context().close();
});
