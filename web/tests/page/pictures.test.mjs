// The page looks as it did: paused scenes and the layout of a phone against committed pictures. UPDATE=yes draws them
// anew, after which a person looks at them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { beside, difference, start, steps, tab } from "./browser.mjs";

/** Largest mean difference, of 255. */
const LIMIT = 2;
const CASES = [
  { name: "crib", settings: { scene: "crib", behavior: "self_touch" }, width: 960, height: 640 },
  { name: "cubes", settings: { scene: "cubes", behavior: "hand_regard", vision_active: false }, width: 960, height: 640 },
  { name: "floor", settings: { scene: "base", behavior: "none", vision_active: false }, width: 960, height: 640, scheme: "dark" },
  { name: "phone", settings: { scene: "crib", behavior: "self_touch" }, width: 390, height: 800, hasTouch: true, isMobile: true },
];
let host;
before(async () => (host = await start()));
after(() => host.stop());

for (const { name, settings, ...view } of CASES) {
  test(`the picture ${name} is as committed`, async () => {
    const page = await host.open({ query: "?paused&quality=full", ...view });
    await tab(page, "Move");
    await page.evaluate((s) => mimo.change(s).then(() => mimo.reset(1)), settings);
    await steps(page, 100);
    await page.evaluate(() => mimo.stage.home());
    await steps(page, 1);
    await page.evaluate(() => document.getElementById("notices").replaceChildren());
    await page.waitForTimeout(600);
    const now = await page.screenshot({ animations: "disabled" });
    const file = `pictures/${name}.png`;
    if (process.env.UPDATE === "yes") writeFileSync(join(import.meta.dirname, file), now);
    const then = beside(file);
    assert.ok(then, `${file} is missing: run with UPDATE=yes`);
    const { mean, most } = await difference(page, now, then);
    console.log(`${name}: mean difference ${mean.toFixed(3)} of 255, largest ${most}`);
    if (mean > LIMIT) writeFileSync(join(import.meta.dirname, `pictures/${name}.now.png`), now);
    assert.ok(mean <= LIMIT, `mean difference ${mean} above ${LIMIT}: compare ${name}.now.png`);
    assert.deepEqual(page.errors, []);
    await page.context().close();
  });
}
