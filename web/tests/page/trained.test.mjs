// The trained policies beside the page.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

/** What each policy does, its file, and for how many steps it goes on here: 300 reach the goal. */
const ALL = [
  ["Reaches for the ball", "reach", 300],
  ["Touches a part of himself", "selfbody", 20],
  ["Stands up", "standup", 20],
  ["Rolls over", "roll_over", 300],
  ["Rolls over at 9 months", "roll_over_9", 300],
  ["Rolls over at 6 months", "roll_over_6", 20],
  ["Catches the ball", "catch", 20],
];

test("each trained policy starts its task and moves him; the first one reaches the ball, and he rolls over at two ages", async () => {
  const page = await host.open();
  await tab(page, "Move");
  for (const [title, file, n] of ALL) {
    const [, behavior, age] = /** @type {RegExpMatchArray} */ (file.match(/^(.+?)(?:_(\d+))?$/));
    const start = page.getByRole("button", { name: title, exact: true });
    await start.click();
    await until(page, ([b, f]) => mimo.scene?.settings.behavior === b && mimo.state.policy === "model" && mimo.model?.name === `${f}.onnx` && (mimo.playing || mimo.moment?.over), [behavior, file]); // one that is quick has ended before it is seen
    assert.equal(await start.getAttribute("aria-pressed"), "true");
    assert.equal(Number((await page.evaluate(() => mimo.scene.settings.age)) ?? 18), Number(age ?? 18));
    await page.evaluate(() => mimo.play(false));
    await page.evaluate(() => mimo.reset(0));
    await steps(page, n);
    const action = await page.evaluate(() => [...mimo.frame.subarray(mimo.scene.layout.action, mimo.scene.layout.angles)]);
    assert.ok(action.some((v) => v !== 0), title);
    if (behavior === "reach") assert.ok(await page.evaluate(() => mimo.moment.over), "the episode ends where the ball is reached");
    if (n === 300) assert.ok(await page.evaluate(() => mimo.moment.score.success), title);
  }
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a link names the policy beside the page instead of carrying it", async () => {
  const page = await host.open();
  await tab(page, "Move");
  await page.getByRole("button", { name: "Reaches for the ball" }).click();
  await until(page, () => mimo.state.policy === "model" && mimo.playing);
  await page.evaluate(() => mimo.play(false));
  const hash = new URL(await page.evaluate(() => mimo.sharing.address(true))).hash;
  const there = await host.open({ hash });
  assert.deepEqual(await there.evaluate(() => [mimo.state.policy, mimo.model.url, mimo.scene.settings.behavior]), ["model", "policies/reach.onnx", "reach"]);
  await page.context().close();
  await there.context().close();
});
