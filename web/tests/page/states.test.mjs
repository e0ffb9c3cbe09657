// States of the world are told, and the button for time says what time does.
import assert from "node:assert/strict";
import { deflateRawSync } from "node:zlib";
import { after, before, test } from "node:test";
import { start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

const message = (page, text) => page.locator("#notices .notice", { hasText: text }).waitFor({ timeout: 60_000 });
const button = (page) => page.locator("#play").getAttribute("aria-label");
const packed = (state) => `#s=${deflateRawSync(Buffer.from(typeof state === "string" ? state : JSON.stringify(state))).toString("base64url")}`;

test("a clock that stops says why, and Pause does not stand while time does", async () => {
  const page = await host.open();
  await page.evaluate(() => {
    mimo.state.held = { 0: NaN };
    mimo.move();
    mimo.play(true);
  });
  await message(page, "Time has stopped: action[0]");
  assert.equal(await button(page), "Play");
  await page.evaluate(() => {
    mimo.state.held = {};
    mimo.move();
  });
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => mimo.moment.steps > 3);
  assert.equal(await page.locator("#notices .notice").count(), 0, "it is no longer so");
  await page.context().close();
});

test("a worker that hangs is told after ten seconds, with a way out", async () => {
  const page = await host.open({ query: "" });
  await until(page, () => mimo.playing);
  await page.evaluate(() => mimo.world.tell("step", 1e9));
  await message(page, "has not answered for 10 seconds");
  assert.equal(await button(page), "Play");
  await page.getByRole("button", { name: "Start again" }).click();
  await until(page, () => mimo.world.alive && mimo.moment?.steps === 0);
  await steps(page, 2);
  assert.equal(await page.evaluate(() => mimo.moment.steps), 2);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a worker that is busy and comes back takes the message away", async () => {
  const page = await host.open();
  // looked at once: the worker is well, and any word of it takes the message away
  const told = await page.evaluate(() => {
    mimo.world.pinged = performance.now() - 60_000; // asked long ago
    mimo.world.look();
    return document.querySelector("#notices").textContent;
  });
  assert.match(told, /has not answered/);
  await steps(page, 1);
  await until(page, () => document.querySelectorAll("#notices .notice").length === 0);
  await page.context().close();
});

test("a change asks before it ends a recording, and keeps what was recorded", async () => {
  const page = await host.open();
  await page.evaluate(() => mimo.world.ask("record"));
  await steps(page, 40);
  await tab(page, "Setup");
  const floor = page.getByRole("group", { name: "Scene" }).getByLabel("Floor");
  await floor.click({ force: true }); // and not check(), which looks whether it stays: it goes back while one is asked
  await page.getByRole("button", { name: "Keep recording" }).click();
  await page.waitForFunction(() => document.querySelector("#panel-setup input[value=crib]").checked);
  assert.deepEqual(await page.evaluate(() => [mimo.scene.settings.scene, mimo.moment.recorded]), ["crib", 40]);
  await page.locator("#scene").focus();
  await page.keyboard.press("r");
  await page.getByRole("dialog").getByText("A reset ends the running recording").waitFor();
  await page.keyboard.press("Escape");
  await floor.click({ force: true });
  await page.getByRole("button", { name: "End it and go on" }).click();
  await until(page, () => mimo.scene.settings.scene === "base");
  await message(page, "0.2 s are kept");
  await tab(page, "Move");
  assert.ok((await page.getByLabel("Part to pull").locator("option").count()) > 5, "parts can be chosen again");
  await tab(page, "Share");
  await page.getByRole("button", { name: "Replay", exact: true }).click();
  await message(page, "The replay is over: 40 steps. It ends with the same bits.");
  assert.equal(await page.evaluate(() => mimo.state.policy), "babbling", "the policy is what it was");
  assert.equal(await button(page), "Play");
  await page.context().close();
});

test("a task's episode ends, its return stands, and the next one is offered", async () => {
  const page = await host.open();
  await page.evaluate(() => {
    mimo.state.policy = "zero";
    mimo.move();
    return mimo.begin({ behavior: "catch", vision_active: false, max_episode_steps: 60 });
  });
  await tab(page, "Watch");
  await page.locator("#panel-watch").getByText("Hold the ball").waitFor();
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => mimo.moment.over);
  await message(page, "Catch:");
  assert.equal(await button(page), "Play");
  const ended = await page.evaluate(() => [mimo.moment.steps, mimo.moment.score.earned]);
  await steps(page, 5);
  assert.deepEqual(await page.evaluate(() => [mimo.moment.steps, mimo.moment.score.earned]), ended);
  await page.getByRole("button", { name: "Next episode" }).click();
  await until(page, (n) => mimo.state.seed === 1 && !mimo.moment.over && mimo.moment.steps < n, ended[0]);
  await until(page, () => mimo.moment.over);
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => mimo.state.seed === 2);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("what a link asks for in vain is named, and the rest kept", async () => {
  const settings = { behavior: "self_touch", scene: "moon", age: 6, touch_scale: -1, vision_active: false };
  const page = await host.open({ hash: packed({ settings, seed: 1.5, speed: "x", vigour: 9, policy: "genius", locks: ["robot:third_elbow"], view: [1] }) });
  const said = await page.locator("#notices .notice").innerText();
  for (const part of ['scene "moon"', "touch_scale -1", "seed 1.5", 'speed "x"', "vigour 9", 'policy "genius"', "robot:third_elbow", "view"]) assert.ok(said.includes(part), `${part}: ${said}`);
  assert.deepEqual(await page.evaluate(() => [mimo.scene.settings.age, mimo.state.seed, mimo.state.speed]), [6, 0, 1]);
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => mimo.moment.steps > 3);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a link that unpacks to far more than it holds is refused, and the page starts", async () => {
  const page = await host.open({ hash: packed(`{"settings":"${" ".repeat(64 << 20)}"}`) });
  await message(page, "The link is damaged");
  assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "crib");
  await page.context().close();
});
