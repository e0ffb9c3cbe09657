// NumPy archives without a browser: what is written is read, and damage is told.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fromFile, toFile } from "../../page/src/recording.js";
import { read, write } from "../../page/src/npz.js";

const recording = {
  qpos0: Float64Array.of(0.1, -2, 3e-300),
  qvel0: Float64Array.of(0, 1),
  activity0: new Float64Array(0),
  actions: Float32Array.of(0.25, -1, 0.5, 1, 0, -0.125),
  steps: 3,
  yaml: "scene: crib\n",
  end: Float64Array.of(1, 2, 3),
};

test("a recording comes back as it was", async () => {
  const bytes = new Uint8Array(await toFile(recording).arrayBuffer());
  assert.deepEqual(await fromFile(bytes), recording);
});

test("arrays keep their shapes and bits", async () => {
  const data = Float64Array.from({ length: 12 }, (_, i) => Math.sin(i) * 10 ** (i - 6));
  const back = await read(write({ a: { shape: [3, 4], data }, b: { shape: [0, 5], data: new Float32Array(0) } }));
  assert.deepEqual(back.a, { shape: [3, 4], data });
  assert.deepEqual(back.b.shape, [0, 5]);
});

test("what is not a recording is refused in words", async () => {
  await assert.rejects(fromFile(new Uint8Array(100)), /not a NumPy archive/);
  await assert.rejects(fromFile(write({ qpos0: { shape: [1], data: new Float64Array(1) } })), /qpos0, qvel0 and actions/);
  const whole = new Uint8Array(await toFile(recording).arrayBuffer());
  for (let cut = 0; cut < whole.length; cut += 7) await assert.rejects(fromFile(whole.slice(0, cut)));
});
