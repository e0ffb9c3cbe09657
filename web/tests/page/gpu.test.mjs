// The library's wgpu renderer on WebGL2: GPU names the folder of the module that `.ci/web` builds of web/tests/gpu.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { start } from "./browser.mjs";

const folder = process.env.GPU;
let host;
before(async () => (host = await start()));
after(() => host.stop());

test("an image of WebGL2 is read, though nothing else is drawn", { skip: !folder && "GPU names no folder" }, async () => {
  const page = await host.open({ query: "NOTICE", wait: false }); // any address, for modules come from addresses
  const types = { js: "text/javascript", wasm: "application/wasm" };
  await page.route("**/gpu/*", (route) => {
    const file = route.request().url().split("/").at(-1);
    return route.fulfill({ body: readFileSync(join(String(folder), file)), contentType: types[file.split(".").at(-1)] });
  });
  const side = 96;
  const { adapter, mean } = await page.evaluate(async ([pixels, patience]) => {
    const module = await import(new URL("gpu/gpu.js", location.href).href);
    await module.default();
    const late = new Promise((_, no) => setTimeout(() => no(new Error("the image never came")), patience));
    const [adapter, found, own] = await Promise.race([module.draw(new OffscreenCanvas(64, 64), pixels), late]);
    return { adapter, mean: found.reduce((sum, v, i) => sum + Math.abs(v - own[i]), 0) / own.length };
  }, [side, 120_000]);
  console.log(`${adapter}: ${mean.toFixed(2)} of 255 from the CPU's image`);
  assert.ok(mean < 2, `${mean}`);
  await page.context().close();
});
