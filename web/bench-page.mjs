// Cost of a visit to the page: `node web/bench-page.mjs [SECONDS]`, after `web/build.sh`. It prints when the parts of the
// first picture were there, in the median of five visits of a server on this machine and of one behind a line of 10 Mbit/s and
// 40 ms, with what went over that line; and then plays in the tab with the eyes for so long (60 s).
import { connect, createServer } from "node:net";
import { chromium } from "playwright-core";
import { serve } from "./page/serve.mjs";

const VISITS = 5;
const seconds = Number(process.argv[2] ?? 60);
const server = await serve(new URL("dist", import.meta.url).pathname);
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args });
const median = (/** @type {number[]} */ values) => values.sort((a, b) => a - b)[values.length >> 1];

/**
 * Visits an address and prints the medians.
 * @param {string} title
 * @param {string} url
 * @param {{ bytes: number }} [line] What counts the bytes that come from there.
 */
const visits = async (title, url, line) => {
  /** @type {Map<string, number[]>} */
  const marks = new Map();
  const sizes = [];
  for (let visit = 0; visit < VISITS; visit++) {
    if (line) line.bytes = 0;
    const context = await browser.newContext({ viewport: { width: 900, height: 640 } });
    const page = await context.newPage();
    await page.goto(`${url}?paused`);
    await page.waitForFunction(() => performance.getEntriesByName("first frame").length, null, { timeout: 120_000 });
    for (const { name, startTime } of await page.evaluate(() => performance.getEntriesByType("mark").map((m) => ({ name: m.name, startTime: m.startTime })))) {
      marks.set(name, [...(marks.get(name) ?? []), startTime]);
    }
    sizes.push(line?.bytes ?? 0);
    await context.close();
  }
  console.log(`${title}:`);
  for (const [name, times] of marks) console.log(`  ${name}: ${median(times).toFixed(0)} ms after the address was opened`);
  if (line) console.log(`  ${(median(sizes) / 1e6).toFixed(2)} MB until then`);
};

/**
 * Simulates a network line in front of a server: all connections share its rate, and each waits one round trip before it carries data.
 * @param {string} url
 * @param {number} rate Bytes per second.
 * @param {number} delay Milliseconds there and back.
 */
const behindLine = async (url, rate, delay) => {
  const line = { url: "", bytes: 0, close: () => {} };
  let free = 0;
  const proxy = createServer((near) => {
    const far = connect(Number(new URL(url).port), "127.0.0.1");
    for (const [side, other] of [[near, far], [far, near]]) {
      side.on("error", () => other.destroy());
      side.on("close", () => setTimeout(() => other.end(), delay));
    }
    let opened = delay;
    near.on("data", (data) => {
      setTimeout(() => far.writable && far.write(data), opened);
      opened = 0;
    });
    far.on("data", (data) => {
      line.bytes += data.length;
      free = Math.max(free, performance.now()) + (1000 * data.length) / rate;
      setTimeout(() => near.writable && near.write(data), free - performance.now() + delay);
    });
  });
  await new Promise((done) => proxy.listen(0, "127.0.0.1", () => done(undefined)));
  const address = proxy.address();
  if (typeof address === "object" && address) line.url = `http://127.0.0.1:${address.port}/`;
  line.close = () => proxy.close();
  return line;
};

await visits("from this machine", server.url);
const line = await behindLine(server.url, 10e6 / 8, 40);
await visits("over 10 Mbit/s and 40 ms", line.url, line);
line.close();

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
