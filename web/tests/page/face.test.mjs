// MIMo makes a face: his head looks another way, and the simulation does not notice.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, start, steps, tab, until } from "./browser.mjs";

/** @type {Awaited<ReturnType<typeof start>>} */
let site;
before(async () => (site = await start()));
after(() => site.stop());

const head = (page) => page.evaluate(() => mimo.scene.textures.map((sides) => sides.map(({ pixels }) => pixels.reduce((sum, p, i) => (sum * 31 + p + i) % 1e9, 7))).join());

test("a face is made in the middle of an episode, fetched once, and goes with a link", async () => {
  const page = await site.open();
  /** @type {string[]} */
  const fetched = [];
  page.on("request", (r) => r.url().includes("/faces/") && fetched.push(r.url().split("/").pop() ?? ""));
  await steps(page, 5);
  const [calm, before, view] = [await head(page), await checksum(page), await page.evaluate(() => mimo.stage.orbit.view)];
  await tab(page, "Setup");
  const faces = page.getByLabel("Face", { exact: true });
  const options = await faces.locator("option").evaluateAll((all) => all.map((o) => o.value));
  assert.deepEqual(options, await page.evaluate(() => mimo.world.ask("keys").then((keys) => keys.find((k) => k.name === "facial_expression").options)));
  await faces.selectOption("Happy");
  await until(page, () => mimo.scene.settings.facial_expression === "happy");
  const happy = await head(page);
  assert.notEqual(happy, calm);
  assert.equal(await checksum(page), before);
  assert.deepEqual(await page.evaluate(() => mimo.stage.orbit.view), view);
  await steps(page, 5);
  await faces.selectOption("Calm");
  await until(page, () => mimo.scene.settings.facial_expression === "default");
  assert.equal(await head(page), calm);
  await faces.selectOption("Happy");
  await until(page, () => mimo.scene.settings.facial_expression === "happy");
  assert.deepEqual(fetched, ["face_happy.png"]);
  const link = await page.evaluate(() => mimo.sharing.address(true));
  const there = await site.open({ hash: new URL(link).hash });
  assert.equal(await there.evaluate(() => mimo.scene.settings.facial_expression), "happy");
  assert.equal(await head(there), happy);
  for (const one of [page, there]) await steps(one, 1);
  assert.equal(await checksum(there), await checksum(page));
  assert.deepEqual([...page.errors, ...there.errors], []);
  for (const one of [page, there]) await one.context().close();
});

test("both of two make it, and one that cannot be fetched changes nothing", async () => {
  const page = await site.open({ serviceWorkers: "block" });
  await page.evaluate(() => mimo.compare({ age: 3, policy: "babbling", sensory: 0, motor: 0 }));
  await page.evaluate(() => mimo.face("sad"));
  const textures = (/** @type {string} */ of) => page.evaluate((name) => (name === "second" ? mimo.second : mimo).scene.settings.facial_expression, of);
  assert.deepEqual([await textures("first"), await textures("second")], ["sad", "sad"]);
  await page.route("**/faces/**", (route) => route.fulfill({ status: 404, body: "" }));
  await tab(page, "Setup");
  await page.getByLabel("Face", { exact: true }).selectOption("Angry");
  await page.getByRole("alert").filter({ hasText: /answered 404/ }).waitFor();
  assert.equal(await page.getByLabel("Face", { exact: true }).inputValue(), "sad");
  await page.context().close();
});
