// How much slower a browser is than the native library, in pairs that alternate: `node web/bench.mjs [PAIRS]`. Build first:
// `web/build.sh package` and `cargo build --release --example pace`.
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { root, serve } from "./tests/package/server.mjs";

const pairs = Number(process.argv[2] ?? 5);
const program = join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "release/examples/pace");
const server = await serve();
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage();
await page.goto(server.page);
await page.waitForFunction(() => "pace" in globalThis);
for (const name of ["physics", "eyes", "picture"]) {
  /** @type {[number, number][]} */
  const times = [];
  for (let k = 0; k < pairs; k++) {
    const native = Number(execFileSync(program, [name], { encoding: "utf8" }));
    const there = await page.evaluate((work) => /** @type {any} */ (globalThis).pace(work), name);
    times.push([native, there]);
  }
  const median = (/** @type {number[]} */ values) => values.sort((a, b) => a - b)[values.length >> 1];
  const [native, there, ratio] = [median(times.map((t) => t[0])), median(times.map((t) => t[1])), median(times.map(([a, b]) => b / a))];
  console.log(`${name}: native ${native.toFixed(3)} ms, Chromium ${there.toFixed(3)} ms, ratio ${ratio.toFixed(2)}`);
}
await browser.close();
server.close();
