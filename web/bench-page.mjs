// Cost of a visit to the page: `node web/bench-page.mjs [SECONDS]`, after `web/build.sh`. It prints when the parts of the
// first picture were there, in the median of five visits, and then plays in the tab with the eyes for so long (60 s).
import { chromium } from "playwright-core";
import { serve } from "./page/serve.mjs";

const VISITS = 5;
const seconds = Number(process.argv[2] ?? 60);
const server = await serve(new URL("dist", import.meta.url).pathname);
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args });
const median = (/** @type {number[]} */ values) => values.sort((a, b) => a - b)[values.length >> 1];

/** @type {Map<string, number[]>} */
const marks = new Map();
for (let visit = 0; visit < VISITS; visit++) {
  const context = await browser.newContext({ viewport: { width: 900, height: 640 } });
  const page = await context.newPage();
  await page.goto(`${server.url}?paused`);
  await page.waitForFunction(() => performance.getEntriesByName("first frame").length, null, { timeout: 120_000 });
  for (const { name, startTime } of await page.evaluate(() => performance.getEntriesByType("mark").map((m) => ({ name: m.name, startTime: m.startTime })))) {
    marks.set(name, [...(marks.get(name) ?? []), startTime]);
  }
  await context.close();
}
for (const [name, times] of marks) console.log(`${name}: ${median(times).toFixed(0)} ms after the address was opened`);

const context = await browser.newContext({ viewport: { width: 900, height: 640 } });
const page = await context.newPage();
await page.goto(server.url);
await page.waitForFunction(() => performance.getEntriesByName("first frame").length, null, { timeout: 120_000 });
await page.getByRole("tab", { name: "Watch" }).click();
await page.waitForTimeout(2000);
const played = await page.evaluate(async (s) => {
  const app = /** @type {any} */ (globalThis).mimo;
  let glances = 0;
  app.on("eyes", () => glances++);
  const [time, frames, started] = [app.moment.time, app.stage.frames, performance.now()];
  await new Promise((done) => setTimeout(done, 1000 * s));
  const wall = (performance.now() - started) / 1000;
  return { pace: (app.moment.time - time) / wall, eyes: glances / wall, frames: (app.stage.frames - frames) / wall };
}, seconds);
console.log(`${seconds} s of play: ${played.pace.toFixed(2)} × real time, the eyes ${played.eyes.toFixed(1)} times a second, ${played.frames.toFixed(1)} frames a second`);
await browser.close();
server.close();
