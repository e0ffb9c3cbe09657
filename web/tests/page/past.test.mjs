// The line of time: what one goes back to is what was, and goes on with the same bits.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, drop, eyesOnly, network, start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

const seek = (page, step) => page.evaluate((s) => mimo.seek(s), step);
const line = (page) => page.evaluate(() => mimo.moment.line);
/** Starts the same life again. */
const begin = (page, state) => page.evaluate((s) => {
  Object.assign(mimo.state, s);
  mimo.move();
  return mimo.reset(5);
}, state);

for (const policy of ["babbling", "random", "sine"]) {
  test(`what one goes back to goes on with the same bits (${policy})`, async () => {
    const page = await host.open();
    await begin(page, { policy, held: { 3: 0.4 } });
    const sums = [];
    for (const n of [100, 37, 163, 60]) {
      await steps(page, n);
      sums.push(await checksum(page));
    }
    await begin(page, {});
    await steps(page, 300);
    for (const [at, sum] of [[137, sums[1]], [100, sums[0]], [299, null], [300, sums[2]], [137, sums[1]]]) {
      await seek(page, at);
      assert.equal(await page.evaluate(() => mimo.moment.steps), at);
      if (sum) assert.equal(await checksum(page), sum, `gone to ${at}`);
    }
    // through the rest of the past and beyond it
    await steps(page, 223);
    assert.equal(await checksum(page), sums[3], "played on");
    assert.deepEqual(await line(page), { from: 0, at: 360, to: 360, recording: false });
    assert.deepEqual(page.errors, []);
    await page.context().close();
  });
}

test("a network, a pull and a lock are part of what was", async () => {
  const page = await host.open();
  await page.evaluate((s) => mimo.change(s), eyesOnly);
  await drop(page, "network.onnx", network("network"));
  await until(page, () => mimo.state.policy === "model");
  const life = async () => {
    await page.evaluate(() => mimo.lock("arms", false));
    await page.evaluate(() => mimo.reset(1));
    await steps(page, 40);
    const body = await page.evaluate(() => mimo.scene.bodies.findIndex((b) => b.name === "right_hand" || b.name === "right_lower_arm"));
    await page.evaluate((b) => mimo.pull({ body: b, point: [0, 0, 0], target: [0, 0, 1] }), body);
    await steps(page, 70);
    await page.evaluate(() => mimo.letGo());
    await steps(page, 20);
    await page.evaluate(() => mimo.lock("arms", true));
    await steps(page, 90);
  };
  await life();
  const sum = await checksum(page);
  const locks = await page.evaluate(() => mimo.state.locks.length);
  assert.ok(locks > 0);
  for (const back of [60, 120, 130, 180, 219, 0]) {
    await seek(page, back);
    assert.equal(await page.evaluate(() => mimo.state.locks.length), back < 130 ? 0 : locks, `locks at ${back}`);
    await steps(page, 220 - back);
    assert.equal(await checksum(page), sum, `from ${back}`);
  }
  await steps(page, 30);
  const later = await checksum(page);
  await life();
  await steps(page, 30);
  assert.equal(await checksum(page), later, "and so is what follows");
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("who does something else in the past begins another future", async () => {
  const page = await host.open();
  await begin(page, { policy: "babbling" });
  await steps(page, 150);
  await seek(page, 90);
  await page.evaluate(() => {
    mimo.state.speed = 2;
    mimo.move();
  });
  await steps(page, 1);
  assert.equal((await line(page)).to, 150, "speed changes nothing of what happens");
  await page.evaluate(() => {
    mimo.state.policy = "zero";
    mimo.move();
  });
  await steps(page, 1);
  assert.deepEqual(await line(page), { from: 0, at: 92, to: 92, recording: false });
  await page.context().close();
});

test("thirty seconds are kept, and no more", { timeout: 300_000 }, async () => {
  const page = await host.open();
  await page.evaluate((s) => mimo.begin(s), { behavior: "none", scene: "base", touch_active: false, vision_active: false });
  await steps(page, 3000);
  const sum = await checksum(page);
  await steps(page, 3720);
  assert.deepEqual(await line(page), { from: 720, at: 6720, to: 6720, recording: false });
  await seek(page, 0);
  assert.equal((await line(page)).at, 720);
  await seek(page, 3000);
  assert.equal(await checksum(page), sum);
  await page.context().close();
});

test("a recording has the same line, before and after its end", async () => {
  const page = await host.open();
  await begin(page, { policy: "babbling" });
  await steps(page, 10);
  await page.evaluate(() => mimo.world.ask("record"));
  const sums = [];
  for (const n of [100, 150]) {
    await steps(page, n);
    sums.push(await checksum(page));
  }
  assert.ok(await page.locator("#past").isDisabled(), "a recording that runs is not left");
  await assert.rejects(seek(page, 20), /A recording is running/);
  await tab(page, "Share");
  await page.getByRole("button", { name: "Stop" }).click();
  await page.getByRole("button", { name: "Replay", exact: true }).click();
  await page.getByText("It ends with the same bits.").waitFor({ timeout: 120_000 });
  assert.deepEqual(await line(page), { from: 0, at: 250, to: 250, recording: true });
  await seek(page, 100);
  assert.equal(await checksum(page), sums[0]);
  assert.equal(await page.locator("#past").getAttribute("aria-valuetext"), "0.5 of 1.3 seconds of the recording");
  assert.ok(await page.getByText("Replaying 0.5 s of 1.3 s").isVisible());
  // not yet seen: forward to what no snapshot is of
  await page.evaluate(() => mimo.recordings.replay(mimo.recordings.last, false));
  await seek(page, 100);
  assert.equal(await checksum(page), sums[0]);
  await seek(page, 250);
  assert.equal(await checksum(page), sums[1]);
  await steps(page, 5);
  assert.deepEqual(await line(page), { from: 0, at: 255, to: 255, recording: false });
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("the line is moved by a finger, and what the pointer leaves is where time stands", async () => {
  const page = await host.open({ width: 390, height: 844, hasTouch: true });
  await steps(page, 400);
  const box = await page.locator("#past").boundingBox();
  await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
  await until(page, () => Math.abs(mimo.moment.line.at - 200) < 8 && document.getElementById("past").valueAsNumber === mimo.moment.line.at);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("the line is moved by keys, says where it is, and Play goes on from there", async () => {
  const page = await host.open();
  assert.ok(await page.locator("#past").isDisabled());
  await steps(page, 400);
  const past = page.getByRole("slider", { name: "Moment" });
  const said = () => past.getAttribute("aria-valuetext");
  assert.equal(await said(), "now");
  await past.focus();
  for (const [key, at, text] of [["ArrowLeft", 380, "0.1 seconds ago"], ["PageDown", 0, "2.0 seconds ago"], ["ArrowRight", 20, "1.9 seconds ago"], ["End", 400, "now"], ["Home", 0, "2.0 seconds ago"], [",", 0, "2.0 seconds ago"], [".", 1, "2.0 seconds ago"]]) {
    await page.keyboard.press(key);
    await until(page, (n) => mimo.moment.line.at === n, at);
    await until(page, (t) => document.getElementById("past").ariaValueText === t, text);
  }
  await page.keyboard.press(" ");
  await until(page, () => mimo.moment.line.at > 5);
  await until(page, () => mimo.moment.line.at > 405);
  assert.equal(await page.evaluate(() => mimo.playing), true);
  await page.keyboard.press("ArrowLeft");
  await until(page, () => !mimo.moment.playing && mimo.moment.line.at < mimo.moment.line.to);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});
