// The state of the page is in its link: opened elsewhere it goes on with the same bits.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, ready, start, steps, tab, until } from "./browser.mjs";

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
    const href = await page.evaluate(() => mimo.address(true));
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
