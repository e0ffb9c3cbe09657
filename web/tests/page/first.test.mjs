// The first minute: what somebody sees and tries who has never been here.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { ready, start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

/** Where MIMo's trunk is on the screen. */
const trunk = (page) => page.evaluate(() => {
  const i = mimo.scene.bodies.findIndex((b) => b.name === "lower_body");
  const r = mimo.stage.canvas.getBoundingClientRect();
  const v = mimo.stage.followed.clone().set(...mimo.stage.bodyPoses.subarray(7 * i, 7 * i + 3)).project(mimo.stage.orbit.camera);
  return [r.left + ((v.x + 1) / 2) * r.width, r.top + ((1 - v.y) / 2) * r.height];
});

test("a hint says that MIMo can be pulled, until he was, in this visit and the next; the cursor says so while he moves", async () => {
  const page = await host.open({ query: "" });
  await until(page, () => mimo.moment.playing);
  const hint = page.locator("#hint");
  assert.ok(await hint.isVisible());
  const [x, y] = await trunk(page);
  await page.mouse.move(x, y);
  await page.waitForTimeout(150);
  await page.mouse.move(x + 2, y);
  await until(page, () => getComputedStyle(mimo.stage.canvas).cursor === "grab");
  await page.mouse.down();
  await page.mouse.move(x, y - 40, { steps: 3 });
  await page.mouse.up();
  await hint.waitFor({ state: "hidden" });
  await page.reload();
  await ready(page);
  assert.ok(await hint.isHidden());
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("the camera stays above the mattress, whatever turns it", async () => {
  const page = await host.open();
  await page.evaluate(() => {
    mimo.stage.orbit.turn(0, -9);
    mimo.stage.draw();
  });
  const [camera, mimos] = await page.evaluate(() => [mimo.stage.orbit.camera.position.z, mimo.stage.orbit.at.z]);
  assert.ok(camera > mimos, `${camera} above ${mimos}`);
  await page.evaluate(() => {
    mimo.stage.orbit.view = [0, -1, 1, 0, 0, 0, 1];
    mimo.stage.draw();
  });
  assert.ok((await page.evaluate(() => mimo.stage.orbit.camera.position.z)) > mimos, "nor does a link take it there");
  await page.context().close();
});

test("presets begin with something to see", async () => {
  const page = await host.open();
  await tab(page, "Setup");
  for (const [name, wanted] of [["A newborn’s eyes", { age: 0, vision_acuity: true }], ["Three months, in the crib", { age: 3, scene: "crib" }], ["Hands in sight", { behavior: "hand_regard" }], ["A ball to reach", { behavior: "reach" }]]) {
    await page.getByRole("button", { name }).click();
    await until(page, (w) => Object.entries(w).every(([key, value]) => mimo.scene.settings[key] === value), wanted);
    await page.evaluate(() => mimo.turn);
  }
  await page.context().close();
});

test("what is not there has no legend, and eyes before a plain surface say so", async () => {
  const page = await host.open();
  await tab(page, "Watch");
  await steps(page, 1);
  await page.getByText("Nothing in sight").waitFor();
  assert.ok(await page.locator("#legend").isVisible());
  await page.evaluate(() => mimo.change({ touch_active: false, scene: "cubes" }));
  assert.ok(await page.locator("#legend").isHidden());
  assert.ok(await page.getByText("Heat map of touch").isHidden());
  await steps(page, 1);
  await page.getByText("Nothing in sight").waitFor({ state: "detached" });
  await page.context().close();
});

test("help knows the age and the tasks, names of sliders are whole, and the rug is no water", async () => {
  const page = await host.open();
  await page.evaluate(() => mimo.change({ age: 3 }));
  await page.locator("#help-open").click();
  const text = await page.locator("#help").innerText();
  assert.match(text, /as at 3 months/);
  for (const task of ["Reach:", "Stand up:", "Touch a part:", "Catch:", "Roll over:"]) assert.ok(text.includes(task), task);
  await page.keyboard.press("Escape");
  await tab(page, "Move");
  await page.evaluate(() => document.querySelectorAll("#panel-move details").forEach((d) => (d.open = true)));
  const cut = await page.evaluate(() => [...document.querySelectorAll(".slider > span")].filter((s) => s.scrollWidth > s.clientWidth + 1).map((s) => s.textContent));
  assert.deepEqual(cut, []);
  assert.ok(await page.evaluate(() => mimo.stage.bodies.drawables.filter((d) => d.name === "rug").every((d) => d.texture === null)));
  await page.context().close();
});
