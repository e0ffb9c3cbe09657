// Costs of the page: draw calls, script, memory. Times are printed, never asserted.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { start, steps, until } from "./browser.mjs";

const CONFIGURATIONS = [
  { scene: "crib", behavior: "self_touch" },
  { scene: "cubes", behavior: "hand_regard", vision_active: false },
  { scene: "base", behavior: "none", vision_active: false },
];
let host;
before(async () => (host = await start()));
after(() => host.stop());

test("a frame needs at most 200 draw calls in every scene", async () => {
  const page = await host.open();
  for (const settings of CONFIGURATIONS) {
    await page.evaluate((s) => mimo.change(s), settings);
    await steps(page, 40);
    const { calls, triangles } = await page.evaluate(() => {
      mimo.stage.arrows.visible = mimo.stage.studio.key.castShadow = true;
      mimo.stage.draw();
      return mimo.stage.renderer.info.render;
    });
    const cost = await page.evaluate(async () => {
      mimo.stage.studio.key.castShadow = false; // takes the processor's time, not the script's
      mimo.stage.cost.fill(0);
      mimo.stage.frames = 0;
      for (let i = 0; i < 40; i++) {
        await mimo.world.ask("step", 1);
        await new Promise((done) => { mimo.stage.after.push(done); mimo.stage.invalidate(); });
      }
      return [...mimo.stage.cost.subarray(0, 40)].sort((a, b) => a - b)[20];
    });
    console.log(`${settings.scene}: ${calls} draw calls, ${triangles} triangles, ${cost.toFixed(2)} ms of script in the median frame`);
    assert.ok(calls <= 200, `${settings.scene}: ${calls}`);
  }
  await page.context().close();
});

test("where the processor draws it draws plainly, unless all is asked for", async () => {
  for (const [query, plain] of [["?paused", true], ["?paused&quality=full", false]]) {
    const page = await host.open({ query });
    const [shadows, width, shown] = await page.evaluate(() => [mimo.stage.studio.key.castShadow, mimo.stage.canvas.width, mimo.stage.canvas.clientWidth]);
    assert.equal(shadows, !plain);
    assert.equal(width < shown, plain);
    assert.equal(await page.getByLabel("Shadows").isChecked(), !plain);
    await page.context().close();
  }
});

test("the first frame comes", async () => {
  const page = await host.open();
  const first = await page.evaluate(() => performance.getEntriesByName("first frame")[0]?.startTime);
  console.log(`first frame after ${first.toFixed(0)} ms`);
  assert.ok(first > 0);
  await page.context().close();
});

test("physics runs in the worker, and draws nothing when nothing changes", async () => {
  const page = await host.open();
  const loaded = await page.evaluate(() => performance.getEntriesByType("resource").map((r) => r.name));
  assert.ok(!loaded.some((n) => n.endsWith(".wasm")), "the page itself loads no module");
  const before = await page.evaluate(() => mimo.stage.frames);
  await page.waitForTimeout(700);
  assert.equal(await page.evaluate(() => mimo.stage.frames), before);
  await page.context().close();
});

test("1,000 resets and 50 changes of scene do not grow the memory", async () => {
  const page = await host.open();
  const memory = () => page.evaluate(() => mimo.moment.memory);
  const change = (i) => page.evaluate((s) => mimo.change(s), CONFIGURATIONS[i % CONFIGURATIONS.length]);
  for (let i = 0; i < CONFIGURATIONS.length + 1; i++) await change(i);
  await page.evaluate(() => mimo.reset(0));
  const first = await memory();
  await page.evaluate(async () => {
    for (let i = 0; i < 1000; i++) await mimo.world.ask("reset", i);
    await mimo.world.ask("look");
  });
  // How much is free when more is asked for depends on what the worker was doing; what is lost adds up: a kilobyte at each
  // reset, or a tenth of a scene at each change, would be more.
  assert.ok((await memory()) - first < 2 ** 20, `${await memory()} bytes after 1,000 resets, ${first} before`);
  for (let i = 0; i < 50; i++) await change(i);
  await page.evaluate(() => mimo.world.ask("look"));
  const last = await memory();
  const textures = await page.evaluate(() => mimo.stage.renderer.info.memory);
  console.log(`memory of the module: ${(first / 2 ** 20).toFixed(1)} MiB, then ${(last / 2 ** 20).toFixed(1)} MiB; ${textures.geometries} geometries, ${textures.textures} textures`);
  assert.ok(last - first < 5 * 2 ** 20, `${last} bytes after 50 changes of scene, ${first} before`);
  assert.ok(last <= 64 * 2 ** 20, "at most 64 MiB");
  assert.ok(textures.geometries < 80 && textures.textures < 40, "nothing is left on the graphics card");
  await page.context().close();
});

test("it runs on, and keeps up with time where the machine does", async () => {
  const page = await host.open({ query: "" });
  await until(page, () => mimo.moment.time > 2);
  const pace = await page.evaluate(() => mimo.moment.pace);
  console.log(`${pace.toFixed(2)} × real time`);
  assert.ok(await page.evaluate(() => mimo.playing));
  assert.deepEqual(page.errors, []);
  await page.context().close();
});
