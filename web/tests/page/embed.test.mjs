// The page in other places: in a frame, as a link that unfolds, under its own policy of contents.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { start, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

test("in a frame there is the scene and its time, and a link to the whole page at this moment", async () => {
  const page = await host.open({ query: "?embed", width: 480, height: 320 });
  await until(page, () => mimo.moment.steps > 5);
  for (const [what, shown] of [["#scene", true], [".transport", true], ["#whole", true], ["#panel", false]]) assert.equal(await page.locator(what).isVisible(), shown, what);
  const size = await page.evaluate(() => [document.scrollingElement.scrollHeight, mimo.stage.canvas.clientHeight]);
  assert.deepEqual(size, [320, 320]);
  await page.getByRole("button", { name: "Pause" }).click();
  await until(page, () => !mimo.moment.playing);
  await page.locator("#whole").dispatchEvent("pointerdown");
  await until(page, () => document.getElementById("whole").href.includes("m="));
  const href = await page.locator("#whole").getAttribute("href");
  assert.ok(!href.includes("embed"));
  const there = await host.open({ query: "", hash: new URL(href).hash });
  assert.equal(await there.evaluate(() => mimo.moment.steps), await page.evaluate(() => mimo.moment.steps));
  await there.context().close();
  await page.context().close();
});

test("a link to the page unfolds to a picture, and the page can be kept as an app", async () => {
  const page = await host.open();
  const of = (name) => page.locator(`meta[property="${name}"]`).getAttribute("content");
  assert.match(await of("og:title"), /MIMo/);
  const answer = await fetch(new URL(await of("og:image"), page.url()));
  assert.equal(answer.headers.get("content-type"), "image/png");
  const manifest = await (await fetch(new URL(await page.locator("link[rel=manifest]").getAttribute("href"), page.url()))).json();
  assert.equal(manifest.display, "standalone");
  assert.equal((await fetch(new URL(manifest.icons[0].src, page.url()))).headers.get("content-type"), "image/svg+xml");
  await page.context().close();
});

test("the page keeps to its own policy of contents, which forbids scripts of others", async () => {
  const page = await host.open({ bypassCSP: false, wait: false });
  await page.locator("#veil.gone").waitFor({ state: "attached", timeout: 60_000 });
  await page.locator("#scene").focus();
  await page.keyboard.press(".");
  await page.locator("#clock", { hasText: /0\.0[1-9]/ }).waitFor();
  for (const name of ["Move", "Setup", "Share", "Watch"]) await page.getByRole("tab", { name }).click();
  assert.deepEqual(page.errors, []);
  await page.addScriptTag({ content: "document.title = 'other'" }).catch(() => {});
  assert.equal(await page.title(), "MIMo, a virtual infant");
  await page.context().close();
});
