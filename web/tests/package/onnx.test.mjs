// Policies that are ONNX models.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import initOnnx, { OnnxPolicy } from "../../dist/babybench/onnx.js";
import init, { Env } from "../../dist/babybench/babybench.js";
import { root } from "./server.mjs";

const model = (/** @type {string} */ name) => readFileSync(join(root, "tests/data/policies", `${name}.onnx`));
const parts = ["hands", "fingers", "arms", "feet", "legs", "body", "head"];
const eyesOnly = {
  behavior: "self_touch",
  scene: "crib",
  touch_active: false,
  vision_active: false,
  ...Object.fromEntries(["velocity", "torque", "limits", "actuation"].map((what) => [`proprio_${what}`, false])),
  ...Object.fromEntries(parts.map((part) => [`act_${part}`, false])),
};

before(async () => {
  await init();
  await initOnnx();
});

test("a network computes what its weights say", () => {
  const env = new Env(eyesOnly);
  env.reset(0);
  const policy = new OnnxPolicy(model("network"), env);
  for (let k = 0; k < 10; k++) {
    const { proprioception, vestibular } = env.observation;
    const all = [...proprioception, .../** @type {Float64Array} */ (vestibular)];
    const weight = (/** @type {number} */ i, /** @type {number} */ j) => ((7 * i + 3 * j) % 11) / 64 - 5 / 64;
    const action = policy.act(env);
    assert.equal(action.length, 6);
    action.forEach((value, j) => {
      const wanted = Math.tanh(all.reduce((sum, x, i) => sum + x * weight(i, j), j / 16));
      assert.ok(Math.abs(value - wanted) < 1e-6, `${j}: ${value}, not ${wanted}`);
    });
    env.step(action);
  }
  policy.free();
  env.free();
});

test("eyes go in as images", () => {
  const env = new Env({ ...eyesOnly, vision_active: true, vision_resolution: 8 });
  env.reset(0);
  const policy = new OnnxPolicy(model("eyes"), env);
  const { eye_left, eye_right } = env.observation;
  const wanted = [eye_left, eye_right].flatMap((eye) => [0, 1, 2].map((c) => Array.from(eye ?? []).reduce((sum, v, i) => sum + (i % 3 === c ? v : 0), 0) / (64 * 255)));
  policy.act(env).forEach((value, k) => assert.ok(Math.abs(value - wanted[k]) < 1e-6));
  policy.free();
  env.free();
});

test("whatever is observed goes in by its name", () => {
  const env = new Env({ ...eyesOnly, touch_active: true, touch_pooled: true, vision_active: true, vision_outputs: ["gray"], vision_resolution: 8 });
  env.reset(0);
  assert.deepEqual(
    env.observationSpace.map(({ name, key, dtype }) => [name, key, dtype]),
    [["proprioception", "observation", "float64"], ["touch", "touch", "float32"], ["touch_pooled", "touch_pooled", "float64"], ["eye_left_gray", "eye_left_gray", "uint8"], ["eye_right_gray", "eye_right_gray", "uint8"], ["vestibular", "vestibular", "float64"]],
  );
  for (const { name, shape } of env.observationSpace) assert.equal(env.observation[name]?.length, shape.reduce((n, side) => n * side, 1), name);
  const policy = new OnnxPolicy(model("gray"), env);
  const { eye_left_gray, eye_right_gray } = env.observation;
  const wanted = [eye_left_gray, eye_right_gray].map((eye) => Array.from(eye ?? []).reduce((sum, v) => sum + v, 0) / (64 * 255));
  assert.ok(wanted[0] > 0);
  policy.act(env).forEach((value, k) => assert.ok(Math.abs(value - wanted[k % 2]) < 1e-6));
  const other = new Env({ ...eyesOnly, vision_active: true, vision_resolution: 8 });
  other.reset(0);
  assert.throws(() => policy.act(other), { name: "ArgumentError", argument: "env", message: /observes touch, touch_pooled, eye_left_gray/ });
  for (const one of [policy, env, other]) one.free();
});

test("a model that does not fit tells why", () => {
  const env = new Env(eyesOnly);
  env.reset(0);
  assert.throws(() => new OnnxPolicy(model("wrong_shape"), env, "mine.onnx"), /mine\.onnx: the input/);
  assert.throws(() => new OnnxPolicy(new Uint8Array(8), env), /cannot load the model/);
  env.free();
});
