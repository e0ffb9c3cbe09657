// A trained network that is dropped on the page.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { drop as dropOn, eyesOnly as settings, network as model, start, steps, until } from "./browser.mjs";

let host;
let page;
before(async () => {
  host = await start();
  page = await host.open();
});
after(() => host.stop());

const drop = (name, bytes) => dropOn(page, name, bytes);
const action = () => page.evaluate(() => [...mimo.frame.subarray(mimo.scene.layout.action, mimo.scene.layout.angles)]);

test("the second module is loaded when a model is dropped, and the network acts", async () => {
  /** @type {string[]} */
  const fetched = [];
  page.context().on("request", (request) => fetched.push(request.url()));
  await page.evaluate((s) => mimo.change(s), settings);
  await page.evaluate(() => { mimo.state.policy = "zero"; mimo.move(); });
  await steps(page, 2);
  assert.ok((await action()).every((v) => v === 0));
  assert.ok(!fetched.some((url) => /onnx/.test(url)), fetched.join());
  await drop("mine.onnx", model("network"));
  await until(page, () => mimo.state.policy === "model" && /mine\.onnx moves MIMo now/.test(document.body.textContent));
  assert.ok(fetched.some((url) => /onnx_core_bg\.wasm/.test(url)), fetched.join());
  await steps(page, 1);
  const first = await action();
  assert.equal(first.length, 6);
  assert.ok(first.every((v) => Math.abs(v) < 1) && first.some((v) => v !== 0), first.join());
  await steps(page, 60);
  assert.notDeepEqual(await action(), first, "it decides by what it senses");
});

test("a model that does not fit tells why, and the one before goes on", async () => {
  await drop("other.onnx", model("wrong_shape"));
  await until(page, () => /the input/.test(document.body.textContent));
  await steps(page, 1);
  assert.ok((await action()).some((v) => v !== 0));
  assert.deepEqual(page.errors, []);
});
