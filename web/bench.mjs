// Measures how much slower a browser and this Node are than the native library, in turn: `node web/bench.mjs [TURNS]`. Build first:
// `web/build.sh package` and `cargo build --release --example pace`.
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { root, serve } from "./tests/package/server.mjs";

const turns = Number(process.argv[2] ?? 5);
const program = join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "release/examples/pace");
const server = await serve();
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage();
await page.goto(server.page);
await page.waitForFunction(() => "pace" in globalThis);
const sums = JSON.stringify(join(root, "web/tests/package/sums.js"));
/** @type {Record<string, (name: string) => Promise<number> | number>} */
const sides = {
  native: (name) => Number(execFileSync(program, [name], { encoding: "utf8" })),
  Chromium: (name) => page.evaluate((work) => /** @type {any} */ (globalThis).pace(work), name),
  node: (name) => {
    const text = `import(${sums}).then(async ({ pace }) => console.log(await pace("${name}")))`;
    return Number(execFileSync(process.execPath, ["--eval", text], { encoding: "utf8" }));
  },
};
const median = (/** @type {number[]} */ values) => values.sort((a, b) => a - b)[values.length >> 1];
for (const name of ["physics", "eyes", "picture"]) {
  /** @type {Record<string, number[]>} */
  const times = Object.fromEntries(Object.keys(sides).map((side) => [side, []]));
  for (let k = 0; k < turns; k++) for (const [side, time] of Object.entries(sides)) times[side].push(await time(name));
  const shown = Object.entries(times).map(([side, all]) => {
    const ratio = median(all.map((time, k) => time / times.native[k]));
    return `${side} ${median([...all]).toFixed(3)} ms` + (side === "native" ? "" : ` (${ratio.toFixed(2)} times)`);
  });
  console.log(`${name}: ${shown.join(", ")}`);
}
await browser.close();
server.close();
