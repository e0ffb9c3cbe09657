// A trained network that is dropped on the page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { start, steps, until } from "./browser.mjs";

const model = (name) => readFileSync(join(import.meta.dirname, `../../../tests/data/policies/${name}.onnx`));
const parts = ["hands", "fingers", "arms", "feet", "legs", "body", "head"];
/** What the networks were made for: the eyes alone move, and little is sensed. */
const settings = {
  behavior: "self_touch",
  touch_active: false,
  vision_active: false,
  ...Object.fromEntries(["velocity", "torque", "limits", "actuation"].map((what) => [`proprio_${what}`, false])),
  ...Object.fromEntries(parts.map((part) => [`act_${part}`, false])),
};
let host;
let page;
before(async () => {
  host = await start();
  page = await host.open();
});
after(() => host.stop());

/** Drops a file on the page, as a person does. */
const drop = (name, bytes) => page.evaluate(([file, numbers]) => {
  const data = new DataTransfer();
  data.items.add(new File([Uint8Array.from(numbers)], file));
  document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
}, [name, [...bytes]]);
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
