// Pulling by hand: parts follow the pointer, and nothing remains when it lets go.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, start, steps, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

/** Where a body is in the world and on the screen. */
const where = (page, name) =>
  page.evaluate((wanted) => {
    const i = mimo.scene.bodies.findIndex((b) => b.name === wanted);
    const at = [...mimo.stage.bodyPoses.subarray(7 * i, 7 * i + 3)];
    const r = mimo.stage.canvas.getBoundingClientRect();
    const v = mimo.stage.followed.clone().set(...at).project(mimo.stage.orbit.camera);
    return { at, x: r.left + ((v.x + 1) / 2) * r.width, y: r.top + ((1 - v.y) / 2) * r.height };
  }, name);

/** Drags what is at a body's place upwards on the screen and returns how far the body moved, m. */
async function drag(page, name, up) {
  const start = await where(page, name);
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.mouse.move(start.x, start.y - up / 2, { steps: 3 });
  await page.mouse.move(start.x, start.y - up, { steps: 3 });
  assert.equal(await page.evaluate(() => mimo.held), true, `the pointer has got hold of ${name}`);
  await steps(page, 300);
  const end = await where(page, name);
  return Math.hypot(...end.at.map((v, k) => v - start.at[k]));
}

for (const [name, least] of [["right_hand", 0.1], ["hip", 0.03]]) {
  test(`dragging the ${name} moves it by at least ${100 * least} cm, and release leaves no force`, async () => {
    const page = await host.open();
    await page.evaluate(() => {
      mimo.state.policy = "zero";
      mimo.move();
      return mimo.change({ scene: "base", behavior: "none", vision_active: false });
    });
    await steps(page, 1);
    const moved = await drag(page, name, 200);
    console.log(`${name} moved ${(100 * moved).toFixed(1)} cm`);
    assert.ok(moved >= least, `moved ${moved} m`);
    assert.ok(await page.evaluate(() => mimo.moment.pull.force > 0));
    assert.ok(await page.evaluate(() => mimo.stage.spring.visible), "the spring shows");
    await page.mouse.up();
    await until(page, () => mimo.moment.pull === null);
    // from here on the run is that of a world which nobody ever pulled
    const snapshot = await page.evaluate(async () => [...(await mimo.world.ask("snapshot"))]);
    await steps(page, 50);
    const pulled = await checksum(page);
    await page.evaluate(async (bytes) => {
      await mimo.make(mimo.state.settings, Uint8Array.from(bytes));
    }, snapshot);
    await steps(page, 50);
    assert.equal(await checksum(page), pulled);
    assert.equal(await page.evaluate(() => mimo.stage.spring.visible), false);
    assert.deepEqual(page.errors, []);
    await page.context().close();
  });
}
