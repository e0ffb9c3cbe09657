// Environments in a worker of a browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { launch, noChromium } from "../launch.mjs";
import { serve } from "./server.mjs";

test("a worker steps, draws and tells errors", { skip: noChromium }, async () => {
  const browser = await launch();
  const server = await serve();
  try {
    const page = await browser.newPage();
    await page.goto(server.page);
    const seen = await page.evaluate(async () => {
      const { connect } = await import(String("../../dist/babybench/remote.js"));
      const worker = connect();
      const env = await worker.create({ behavior: "self_touch", scene: "crib", vision_active: false });
      await env.call("reset", 0);
      const step = await env.call("step", await env.call("sampleAction"));
      const picture = await env.call("draw", "closeup", 20, 10);
      const error = await worker.create({ scene: "moon" }).catch((/** @type {any} */ e) => [e instanceof Error, e.name, e.key]);
      const gone = await env.call("fly").catch((/** @type {Error} */ e) => e.message);
      await env.free();
      worker.close();
      return [step.observation.touch.length, step.info.steps, picture.length, error, gone];
    });
    assert.deepEqual(seen, [5723, 1, 800, [true, "ConfigError", "scene"], "an environment has no fly"]);
  } finally {
    await browser.close();
    server.close();
  }
});
