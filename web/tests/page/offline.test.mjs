// The page opens again without its server.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { checksum, ready, start, steps } from "./browser.mjs";

let host;
before(async () => (host = await start()));
after(() => host.stop());

test("after a visit the page opens, steps and sees without a network", async () => {
  const page = await host.open();
  await page.evaluate(() => navigator.serviceWorker.ready);
  await steps(page, 5);
  const first = await checksum(page);
  host.hangUp();
  await assert.rejects(fetch(host.url), "the server is gone");
  await page.reload();
  await ready(page);
  await steps(page, 5);
  assert.equal(await checksum(page), first);
  const eye = await page.evaluate(() => mimo.world.ask("eyes"));
  assert.ok(eye, "the eyes see");
  assert.equal(await page.evaluate(() => document.fonts.ready.then(() => document.fonts.check("16px Inter"))), true);
  await page.context().close();
});
