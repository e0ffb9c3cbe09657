// The state of the page is in its link: opened elsewhere it goes on with the same bits.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, drop, eyesOnly, network, ready, start, steps, tab, until } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

for (const policy of ["babbling", "random", "sine"]) {
  test(`a link to a moment goes on with the same bits (${policy})`, async () => {
    const page = await host.open();
    await page.evaluate((p) => {
      Object.assign(mimo.state, { policy: p, held: { 3: 0.4 } });
      mimo.move();
      return mimo.reset(5);
    }, policy);
    await steps(page, 77);
    const href = await page.evaluate(() => mimo.sharing.address(true));
    console.log(`link of ${href.length} characters`);
    assert.ok(href.length < 16_000);
    await steps(page, 60);
    const here = await checksum(page);
    const there = await host.open({ query: "?paused", hash: new URL(href).hash });
    assert.equal(await there.evaluate(() => mimo.moment.steps), 77);
    await steps(there, 60);
    assert.equal(await checksum(there), here);
    assert.deepEqual(there.errors, []);
    await there.context().close();
    await page.context().close();
  });
}

test("the button puts the link into the address, and a reload goes on from it", async () => {
  const page = await host.open();
  await steps(page, 30);
  await tab(page, "Share");
  await page.getByRole("button", { name: "Copy link to this moment" }).click();
  await until(page, () => location.hash.length > 100);
  // what is felt is not in a snapshot: the next step feels it
  await steps(page, 1);
  const before = await checksum(page);
  await page.reload();
  await ready(page);
  assert.equal(await page.evaluate(() => mimo.moment.steps), 30);
  await steps(page, 1);
  assert.equal(await checksum(page), before);
  await page.context().close();
});

test("a damaged link starts afresh and says so", async () => {
  const page = await host.open({ hash: "#s=AAAA" });
  await page.getByText("The link is damaged").waitFor();
  assert.ok(await page.evaluate(() => mimo.scene.settings.scene === "crib"));
  await page.context().close();
});

const hash = (page) => page.evaluate(async () => new URL(await mimo.sharing.address(true)).hash);
const idle = (page) => page.evaluate(() => mimo.turn);

test("a link that is pasted into an open page is opened, and back and forward go where it was", async () => {
  const page = await host.open();
  await page.evaluate(() => mimo.change({ scene: "base" }));
  await steps(page, 10);
  const link = await hash(page);
  await page.evaluate(() => mimo.change({ scene: "cubes" }));
  await until(page, () => history.state?.state.settings.scene === "cubes");
  await page.evaluate((h) => { location.hash = h; }, link);
  await until(page, () => mimo.scene.settings.scene === "base" && mimo.moment.steps === 10);
  await idle(page);
  await page.goBack();
  await until(page, () => mimo.scene.settings.scene === "cubes" && mimo.moment.steps === 0);
  await idle(page);
  await page.goForward();
  await until(page, () => mimo.scene.settings.scene === "base" && mimo.moment.steps === 10);
  await page.evaluate(() => { location.hash = "#s=AAAA"; });
  await page.getByText("What is here stays").waitFor();
  assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "base");
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("moments that were asked for are entries of the history", async () => {
  const page = await host.open();
  await tab(page, "Share");
  for (const n of [20, 30]) {
    await steps(page, n);
    const before = await page.evaluate(() => location.hash);
    await page.getByRole("button", { name: "Copy link to this moment" }).click();
    await until(page, (h) => location.hash !== h, before);
  }
  await page.goBack();
  await until(page, () => mimo.moment.steps === 20);
  await idle(page);
  await page.goForward();
  await until(page, () => mimo.moment.steps === 50);
  await page.context().close();
});

test("settings, theme and tab survive a reload; what was changed after a link does, too", async () => {
  const page = await host.open();
  await tab(page, "Move");
  await page.locator("#theme").click();
  await page.evaluate(() => mimo.change({ scene: "base", age: 6 }));
  await page.evaluate(() => mimo.reset(4));
  await page.evaluate(() => { mimo.state.vigour = 0.25; mimo.move(); });
  const now = () => page.evaluate(() => [mimo.scene.settings.scene, mimo.scene.settings.age, mimo.state.seed, mimo.state.vigour, document.documentElement.dataset.theme, document.getElementById("panel-move").hidden]);
  const before = await now();
  await until(page, () => history.state?.state.vigour === 0.25);
  await page.reload();
  await ready(page);
  assert.deepEqual(await now(), before);
  await tab(page, "Share");
  await page.getByRole("button", { name: "Copy link to this moment" }).click();
  await until(page, () => mimo.sharing.linked !== null);
  await page.evaluate(() => mimo.change({ age: 3 }));
  await until(page, () => history.state?.state.settings.age === 3);
  await page.reload();
  await ready(page);
  assert.equal(await page.evaluate(() => mimo.scene.settings.age), 3, "the change, not the link");
  await page.goBack();
  await until(page, () => mimo.scene.settings.age === 6);
  await page.context().close();
});

test("a link carries a small network and goes on with the same bits; so does a new start", async () => {
  const page = await host.open();
  await page.evaluate((s) => mimo.change(s), eyesOnly);
  await drop(page, "mine.onnx", network("network"));
  await until(page, () => mimo.state.policy === "model");
  await steps(page, 20);
  const link = await hash(page);
  await steps(page, 40);
  const wanted = await checksum(page);
  const there = await host.open({ hash: link });
  assert.deepEqual(await there.evaluate(() => [mimo.state.policy, mimo.model.name]), ["model", "mine.onnx"]);
  await steps(there, 40);
  assert.equal(await checksum(there), wanted);
  await there.reload();
  await ready(there);
  assert.equal(await there.evaluate(() => mimo.state.policy), "model");
  await there.context().close();
  await page.evaluate(() => mimo.revive());
  await steps(page, 60);
  assert.equal(await page.evaluate(() => mimo.state.policy), "model");
  assert.equal(await checksum(page), wanted, "the same network moves him");
  // a network that no longer fits is told, and none is said to decide
  await page.evaluate(() => mimo.change({ proprio_velocity: true }));
  await page.getByText("mine.onnx does not fit this configuration").waitFor();
  assert.equal(await page.evaluate(() => mimo.state.policy), "babbling");
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a network that is too large for a link is named, here and there", async () => {
  const page = await host.open();
  await page.evaluate((s) => mimo.change(s), eyesOnly);
  await drop(page, "mine.onnx", network("network"));
  await until(page, () => mimo.state.policy === "model");
  await page.evaluate(() => {
    const noise = new Uint8Array(80_000);
    for (let i = 0; i < noise.length; i += 65_536) crypto.getRandomValues(noise.subarray(i, i + 65_536));
    mimo.model.bytes = noise; // as large as trained ones are
  });
  await tab(page, "Share");
  await page.getByRole("button", { name: "Copy link to this moment" }).click();
  await page.getByText("It does not hold the network mine.onnx").waitFor();
  const there = await host.open({ hash: await page.evaluate(() => location.hash) });
  await there.getByText("was moved by mine.onnx").waitFor();
  assert.equal(await there.evaluate(() => mimo.state.policy), "babbling");
  await drop(there, "mine.onnx", network("network"));
  await until(there, () => mimo.state.policy === "model");
  assert.equal(await there.getByText("was moved by mine.onnx").count(), 0);
  await there.context().close();
  await page.context().close();
});

test("a policy, a recording and a configuration come from addresses, and what does not is told", async () => {
  const files = {
    "own.yml": Object.entries({ ...eyesOnly, scene: "base" }).map(([key, value]) => `${key}: ${value}\n`).join(""),
    "net.onnx": network("network"),
  };
  const page = await host.open({ query: "?paused&config=own.yml&policy=net.onnx&recording=gone.npz", routes: files });
  assert.deepEqual(await page.evaluate(() => [mimo.scene.settings.scene, mimo.state.policy, mimo.model.name]), ["base", "model", "net.onnx"]);
  await page.getByText("gone.npz cannot be fetched: the server answers 404").waitFor();
  const link = new URL(await page.evaluate(() => mimo.sharing.address(true)));
  assert.ok(!link.hash.includes("&n="), "its address is enough");
  await page.context().close();
});
