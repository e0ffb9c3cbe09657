// Two MIMos side by side: each is as he is alone, one clock moves both, and the second leaves nothing behind.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { start, steps, tab, until } from "./browser.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const twin = { age: 3, policy: "random", sensory: 50, motor: 100 };
let host;
before(async () => (host = await start()));
after(() => host.stop());

const compare = (page, second) => page.evaluate((t) => mimo.compare(t), second);
const sums = (page) => page.evaluate(() => Promise.all([mimo.world.ask("checksum"), mimo.world.ask("checksum", true)]));

test("each is as he is alone, also when both go back, and in a link", async () => {
  const alone = await host.open();
  await alone.evaluate(() => mimo.reset(4));
  await steps(alone, 160);
  const first = await alone.evaluate(() => mimo.world.ask("checksum"));
  await alone.evaluate((t) => mimo.change({ age: t.age, delay_unit: "ms", delay_sensory: t.sensory, delay_motor: t.motor }), twin);
  await alone.evaluate((t) => {
    mimo.state.policy = t.policy;
    mimo.move();
    return mimo.reset(4);
  }, twin);
  await steps(alone, 160);
  const second = await alone.evaluate(() => mimo.world.ask("checksum"));
  await alone.context().close();

  const page = await host.open();
  await page.evaluate(() => mimo.reset(4));
  await compare(page, twin);
  await steps(page, 100);
  const href = await page.evaluate(() => mimo.sharing.address(true));
  console.log(`link of ${href.length} characters`);
  await steps(page, 60);
  assert.deepEqual(await sums(page), [first, second], "alone and beside");
  await page.evaluate(() => mimo.seek(30));
  await steps(page, 130);
  assert.deepEqual(await sums(page), [first, second], "gone back");
  const there = await host.open({ hash: new URL(href).hash });
  assert.equal(await there.evaluate(() => mimo.moment.steps), 100);
  await steps(there, 60);
  assert.deepEqual(await sums(there), [first, second], "in a link");
  assert.deepEqual([...page.errors, ...there.errors], []);
  await there.context().close();
  await page.context().close();
});

test("he is set in the tab Setup, drawn beside the first from the same side, and has eyes", async () => {
  const page = await host.open({ width: 1280, height: 800 });
  await tab(page, "Setup");
  await page.getByLabel("A second MIMo beside him").check();
  await until(page, () => mimo.second.stage?.frames > 0);
  await page.getByLabel("What moves the second").selectOption("sine");
  await page.getByLabel("Months of the second").fill("9");
  await until(page, () => mimo.second.scene?.settings.age === 9);
  await page.getByText("9 months · Sine").waitFor();
  await page.getByText("Original size · Babbling").waitFor();
  const [left, right] = await Promise.all(["#scene", "#second"].map((s) => page.locator(s).boundingBox()));
  assert.ok(Math.abs(left.width - right.width) < 2 && Math.abs(left.x + left.width - right.x) < 2, JSON.stringify([left, right]));
  await page.locator("#second").focus();
  await page.keyboard.press("ArrowLeft");
  await until(page, () => mimo.stage.orbit.view.join() === mimo.second.stage.orbit.view.join());
  await tab(page, "Watch");
  await page.getByRole("img", { name: "What the second MIMo’s left eye sees" }).waitFor();
  // another scene has both again
  await page.evaluate(() => mimo.change({ scene: "cubes" }));
  await until(page, () => mimo.second.scene.settings.scene === "cubes" && mimo.second.scene.settings.age === 9);
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run());
  assert.deepEqual(violations.filter((v) => v.impact === "serious" || v.impact === "critical").map((v) => v.id), []);
  await page.evaluate(() => mimo.play(true));
  await until(page, () => mimo.moment.steps > 20);
  await page.evaluate(() => mimo.play(false));
  await until(page, () => !mimo.moment.playing);
  await page.waitForTimeout(300); // until what was remembered is in the history
  await page.reload();
  await until(page, () => globalThis.mimo?.second.scene?.settings.age === 9);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("the second can be pulled, and his future is another then", async () => {
  const page = await host.open();
  await compare(page, { ...twin, policy: "zero" });
  const life = async (pulled) => {
    await page.evaluate(() => mimo.reset(0));
    await steps(page, 20);
    if (pulled) await page.evaluate(() => mimo.pull({ body: mimo.scene.bodies.findIndex((b) => b.name === "head"), point: [0, 0, 0], target: [0, 0, 2] }, true));
    await steps(page, 40);
    await page.evaluate(() => mimo.letGo(true));
    return sums(page);
  };
  const [calm, pulled] = [await life(false), await life(true)];
  assert.equal(calm[0], pulled[0]);
  assert.notEqual(calm[1], pulled[1]);
  await page.evaluate(() => mimo.seek(10));
  await steps(page, 50);
  assert.deepEqual(await sums(page), pulled);
  await page.context().close();
});

test("he goes away, and leaves no memory, picture or word behind", async () => {
  const page = await host.open();
  const used = [];
  for (let i = 0; i < 4; i++) {
    await compare(page, twin);
    await steps(page, 5);
    await compare(page, null);
    await steps(page, 5);
    used.push(await page.evaluate(() => mimo.moment.memory));
  }
  console.log(`memory after each: ${used.map((bytes) => `${(bytes / 1e6).toFixed(1)} MB`).join(", ")}`);
  // an environment takes megabytes; that a piece finds no gap of its size, and memory grows by a page, is chance
  assert.ok(used[3] - used[1] < 1e6, "what he took is taken again by the next");
  const left = await page.evaluate(() => [document.querySelectorAll("canvas#second, .who, .two").length, mimo.stage.peer, mimo.state.twin, document.getElementById("scene").clientWidth === document.getElementById("stage").clientWidth]);
  assert.deepEqual(left, [0, null, null, true]);
  await assert.rejects(page.evaluate(() => mimo.world.ask("checksum", true)), /MIMo is alone/);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("what two cannot do is said: a pace, a recording, an age that there is not", async () => {
  const page = await host.open();
  await compare(page, twin);
  await page.evaluate(() => {
    for (let i = 0; i < 60; i++) mimo.emit("tick", { ...mimo.moment, playing: true, pace: 0.4 });
  });
  await page.getByText("too slow for two MIMos at 1 ×: a second takes them 2.5 s").waitFor();
  await assert.rejects(page.evaluate(() => mimo.world.ask("record")), /end the comparison first/);
  await page.getByRole("button", { name: "End the comparison" }).click();
  await until(page, () => !mimo.second.scene && mimo.moment.steps === 0);
  await page.evaluate(() => mimo.world.ask("record"));
  await steps(page, 30);
  await page.evaluate(() => mimo.recordings.end());
  await compare(page, twin);
  await tab(page, "Share");
  await page.getByRole("button", { name: "Replay", exact: true }).click();
  await page.getByText("It ends with the same bits.").waitFor({ timeout: 60_000 });
  assert.equal(await page.evaluate(() => mimo.state.twin), null);
  await compare(page, { ...twin, age: 400 });
  await page.getByText("There is no second MIMo: ").waitFor();
  assert.equal(await page.evaluate(() => mimo.state.twin), null);
  await steps(page, 3);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});
