// Wrong arguments: each exported function says which one is wrong, and the module goes on.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import initOnnx, * as onnx from "../../dist/babybench/onnx.js";
import init, * as babybench from "../../dist/babybench/babybench.js";
import * as remote from "../../dist/babybench/remote.js";
import { root } from "./server.mjs";

const { Blueprint, Env } = babybench;
const dist = new URL("../../dist/babybench/", import.meta.url).href;
const settings = { behavior: "catch", vision_active: false };
const nothing = () => {};

/** Ten values that an argument of a kind must not have. @type {Record<string, unknown[]>} */
const WRONG = {
  seed: [1.5, -1, NaN, Infinity, "0", { seed: 0 }, null, [0], Symbol("seed"), 2n ** 64n],
  whole: [1.5, -1, NaN, 2 ** 32, "1", null, [1], {}, 1n, nothing],
  finite: [NaN, Infinity, -Infinity, "1", null, [], {}, 1n, Symbol("finite"), true],
  text: [5, null, true, Symbol("text"), {}, [], 1n, nothing, NaN, new Uint8Array(2)],
  flag: [0, 1, "true", null, {}, [], NaN, Symbol("flag"), 1n, nothing],
  bytes: [5, "bytes", null, {}, [1, 2], new Float64Array(2), Symbol("bytes"), 1n, true, new ArrayBuffer(3)],
  numbers: [5, "123", null, {}, new Array(2), ["a", "b", "c"], [NaN, 0, 0], new BigInt64Array(3), Symbol("numbers"), new DataView(new ArrayBuffer(24))],
  rows: [5, "123", null, {}, [[1], [2, 3]], [["a"]], [null], [5], Symbol("rows"), nothing],
  camera: [5, null, true, {}, { lookat: [0, 0], distance: 1, azimuth: 0, elevation: 0 }, { lookat: [0, 0, 0], distance: "1", azimuth: 0, elevation: 0 }, Symbol("camera"), 1n, [], NaN],
  config: [5, null, true, Symbol("config"), 1n, [], nothing, { age: NaN }, { age: Symbol("age") }, { scene: { crib: 1 } }],
  files: [5, null, true, Symbol("files"), 1n, "room.xml", [], new Uint8Array(2), { "room.xml": 5 }, { "room.xml": null }],
  source: [5, null, true, Symbol("source"), 1n, "", {}, [], nothing, NaN],
  env: [5, null, true, Symbol("env"), 1n, "env", {}, [], nothing, NaN],
  worker: [5, null, true, Symbol("worker"), 1n, "worker.js", {}, [], nothing, NaN],
};

/** The arguments of every method: name and kind. @type {Record<string, [string, string][]>} */
const ENV = {
  reset: [["seed", "seed"]],
  resetTo: [["qpos", "numbers"], ["qvel", "numbers"]],
  setState: [["qpos", "numbers"], ["qvel", "numbers"]],
  setActivity: [["activity", "numbers"]],
  setGoal: [["desired", "numbers"]],
  step: [["action", "numbers"]],
  computeReward: [["achieved", "rows"], ["desired", "rows"], ["infos", "rows"]],
  sampleAction: [],
  seedActionSpace: [["seed", "seed"]],
  view: [["name", "text"]],
  update: [],
  texturePixels: [["texture", "whole"], ["face", "whole"]],
  lock: [["target", "text"], ["angle", "finite"]],
  unlock: [["target", "text"]],
  swapFacialExpression: [["expression", "text"]],
  snapshot: [],
  restore: [["bytes", "bytes"]],
  applyForce: [["body", "whole"], ["force", "numbers"], ["torque", "numbers"], ["point", "numbers"]],
  releaseForces: [],
  draw: [["camera", "camera"], ["width", "whole"], ["height", "whole"]],
  deferVision: [["deferred", "flag"]],
  lookThroughEyes: [],
  drawEyes: [],
  checksum: [],
  free: [],
};
const POLICY = { act: [["env", "env"]], free: [] };

const methods = (/** @type {Function} */ kind) => Object.getOwnPropertyNames(kind.prototype).filter((name) => name !== "constructor" && !Object.getOwnPropertyDescriptor(kind.prototype, name)?.get);

/** Arguments that are right. @param {babybench.Env} env @returns {Record<string, unknown>} */
const right = (env) => ({
  seed: 0, qpos: env.view("qpos")?.slice(), qvel: env.view("qvel")?.slice(), activity: env.view("act")?.slice(), action: env.action.slice(),
  desired: Array.from(env.observation.desired_goal ?? []), achieved: [Array.from(env.observation.achieved_goal ?? [])], infos: [env.info],
  name: "qpos", expression: "default", texture: 0, face: 0, target: "hands", angle: 0, bytes: env.snapshot(), body: 3, force: [0, 0, 1], torque: [0, 0, 0], point: [0, 0, 0],
  camera: "closeup", width: 8, height: 8, deferred: false, env,
});

/** Calls with one argument wrong after the other. */
function tryAll(/** @type {string} */ what, /** @type {[string, string][]} */ named, /** @type {Record<string, unknown>} */ good, /** @type {(...args: any[]) => unknown} */ call) {
  for (const [at, [name, kind]] of named.entries()) {
    assert.equal(WRONG[kind].length, 10, kind);
    for (const wrong of WRONG[kind]) {
      const args = named.map(([other], i) => (i === at ? wrong : other === "desired" && what === "computeReward" ? [good.desired] : good[other]));
      const label = `${what}(${name}: ${typeof wrong === "symbol" ? "symbol" : String(wrong?.constructor?.name)} ${Array.isArray(wrong) ? wrong.length : String(wrong)})`;
      assert.throws(() => call(...args), (/** @type {any} */ e) => {
        assert.equal(e.name, "ArgumentError", `${label}: ${e.name}: ${e.message}`);
        assert.ok(e instanceof babybench.ArgumentError && e instanceof TypeError);
        assert.ok(e.argument.startsWith(name) && e.message.startsWith(name), `${label}: ${e.message}`);
        return true;
      }, label);
    }
  }
}

before(async () => {
  await init();
  await initOnnx();
});

test("every method of an environment names the argument that is wrong, for ten wrong values each", () => {
  assert.deepEqual(methods(Env).sort(), Object.keys(ENV).sort(), "the table has every method");
  const env = new Env(settings);
  env.reset(0);
  env.step();
  const wanted = env.checksum();
  for (const [what, named] of Object.entries(ENV)) tryAll(what, named, right(env), (...args) => /** @type {any} */ (env)[what](...args));
  assert.equal(env.checksum(), wanted, "nothing has changed");
  assert.throws(() => env.applyForce(999, [0, 0, 1]), { name: "ArgumentError", argument: "body" });
  env.step();
  env.free();
});

test("every other export names the argument that is wrong", async () => {
  const env = new Env({ behavior: "none", scene: "base", touch_active: false, vision_active: false });
  env.reset(0);
  const model = readFileSync(join(root, "tests/data/policies/network.onnx"));
  const good = { noise: "pink", seed: 0, config: {}, name: "name", assets: {}, bytes: model, env, source: undefined };
  const constructors = /** @type {const} */ ([
    [Env, [["config", "config"], ["name", "text"], ["assets", "files"]]],
    [Blueprint, [["config", "config"], ["name", "text"], ["assets", "files"]]],
    [babybench.ActionNoise, [["noise", "text"], ["env", "env"], ["seed", "seed"]]],
    [onnx.OnnxPolicy, [["bytes", "bytes"], ["env", "env"], ["name", "text"]]],
    [remote.Connection, [["worker", "worker"]]],
  ]);
  for (const [Made, named] of constructors) tryAll(Made.name, /** @type {any} */ (named), good, (...args) => new (/** @type {any} */ (Made))(...args));
  for (const start of [init, initOnnx]) {
    for (const wrong of WRONG.source) await assert.rejects(start(/** @type {any} */ (wrong)), { name: "ArgumentError", argument: "source" });
  }
  for (const wrong of WRONG.text) await assert.rejects(babybench.loadFace(/** @type {any} */ (wrong)), { name: "ArgumentError", argument: "name" });
  for (const wrong of WRONG.source.filter((value) => value !== undefined)) {
    await assert.rejects(babybench.loadFace("happy", /** @type {any} */ (wrong)), { name: "ArgumentError", argument: "source" });
  }
  // what a worker is asked is checked before it goes there
  const sent = [];
  const worker = new remote.Connection(/** @type {any} */ ({ postMessage: (/** @type {unknown} */ d) => sent.push(d), terminate: nothing }));
  const far = new remote.RemoteEnv(worker, 0);
  for (const wrong of WRONG.config) await assert.rejects(worker.create(/** @type {any} */ (wrong)), { name: "ArgumentError" });
  for (const wrong of WRONG.text) {
    await assert.rejects(worker.create({}, /** @type {any} */ (wrong)), { name: "ArgumentError", argument: "name" });
    await assert.rejects(far.call(/** @type {any} */ (wrong)), { name: "ArgumentError", argument: "what" });
  }
  for (const wrong of WRONG.files) await assert.rejects(worker.create({}, "name", /** @type {any} */ (wrong)), { name: "ArgumentError" });
  assert.equal(sent.length, 0);
  worker.close();
  await assert.rejects(far.call("reset"), /the worker was closed/);
  assert.throws(() => remote.connect(), { name: "MissingError", message: /Worker/ });
  // functions without arguments, and classes of errors: nothing can be wrong with them
  const known = ["default", "ActionNoise", "Env", "Blueprint", "configKeys", "memoryBytes", "loadFace", "ArgumentError", "FreedError", "MissingError", "ModuleError", "OnnxPolicy", "Connection", "RemoteEnv", "connect"];
  assert.deepEqual([babybench, onnx, remote].flatMap((m) => Object.keys(m)).filter((name) => !known.includes(name)), []);
  env.free();
});

test("what was freed says so, and may be disposed of twice", () => {
  const env = new Env(settings);
  env.reset(0);
  const good = { ...right(env), achieved: [[0]], desired: [[0]], infos: [{ reward_terms: null }] };
  env[Symbol.dispose]();
  env[Symbol.dispose]();
  for (const [what, named] of Object.entries(ENV)) {
    const args = named.map(([name]) => /** @type {Record<string, unknown>} */ (good)[name]);
    assert.throws(() => /** @type {any} */ (env)[what](...args), { name: "FreedError", message: /environment was freed/ }, what);
  }
  for (const property of ["observation", "info", "time", "model", "look", "skin", "locked", "eyeSizes", "visionDelay", "proprioceptionNames", "action"]) {
    assert.throws(() => JSON.stringify(/** @type {any} */ (env)[property]), { name: "FreedError" }, property);
  }
  const blueprint = new Blueprint(settings);
  blueprint.free();
  for (const use of [() => blueprint.free(), () => blueprint.env(), () => blueprint.yaml, () => new Env(blueprint)]) assert.throws(use, { name: "FreedError", message: /blueprint was freed/ });
  blueprint[Symbol.dispose]();
});

test("a policy that was freed says so, and names what is wrong", () => {
  assert.deepEqual(methods(onnx.OnnxPolicy).sort(), Object.keys(POLICY).sort());
  const parts = ["hands", "fingers", "arms", "feet", "legs", "body", "head"];
  const env = new Env({ behavior: "self_touch", touch_active: false, vision_active: false, ...Object.fromEntries(["velocity", "torque", "limits", "actuation"].map((what) => [`proprio_${what}`, false])), ...Object.fromEntries(parts.map((part) => [`act_${part}`, false])) });
  env.reset(0);
  const policy = new onnx.OnnxPolicy(readFileSync(join(root, "tests/data/policies/network.onnx")), env);
  tryAll("act", [["env", "env"]], {}, (wrong) => policy.act(wrong));
  policy.free();
  for (const use of [() => policy.free(), () => policy.act(env)]) assert.throws(use, { name: "FreedError", message: /policy was freed/ });
  policy[Symbol.dispose]();
  env.free();
});

test("a noise gives the actions of its seed, and names what is wrong", () => {
  const env = new Env(settings);
  const of = (/** @type {string} */ name, /** @type {number} */ seed) => {
    const noise = new babybench.ActionNoise(name, env, seed);
    const actions = Array.from({ length: 30 }, () => Array.from(noise.sample()));
    noise.reset(seed);
    assert.deepEqual(Array.from(noise.sample()), actions[0], name);
    tryAll("reset", [["seed", "seed"]], {}, (wrong) => noise.reset(wrong));
    noise.free();
    for (const use of [() => noise.free(), () => noise.sample(), () => noise.reset(0)]) assert.throws(use, { name: "FreedError", message: /noise was freed/ });
    noise[Symbol.dispose]();
    return actions;
  };
  const all = ["white", "held:0.1", "ou", "pink", "oscillators"].map((name) => of(name, 1));
  assert.deepEqual(of("pink", 1), all[3]);
  assert.equal(new Set([...all, of("pink", 2)].map((actions) => JSON.stringify(actions))).size, 6);
  for (const actions of all) actions.flat().forEach((value, k) => assert.ok(value >= env.model.actions[k % env.model.actions.length].low && value <= env.model.actions[k % env.model.actions.length].high));
  assert.throws(() => new babybench.ActionNoise("brown", env), { name: "ArgumentError", argument: "noise", message: /choose white, held/ });
  env.free();
});

/** Runs a program with the package in a node of its own. */
const run = (/** @type {string} */ program) => execFileSync(process.execPath, ["--input-type=module", "-e", program], { encoding: "utf8", stdio: "pipe" });

test("memory that runs out in a new environment is a ModuleError, and so is every call after it", () => {
  // the module's memory is taken away, so that the next picture finds none
  const out = run(`
    import init, { Env } from "${dist}babybench.js";
    import { module } from "${dist}module.js";
    await init();
    const env = new Env({ vision_active: false });
    env.reset(0);
    for (let pages = 32768; pages >= 1; pages = Math.floor(pages / 2)) try { for (;;) module.memory.grow(pages); } catch {}
    const said = [];
    const told = (use) => { try { use(); said.push("none"); } catch (e) { said.push(e.name); } };
    for (let k = 0; k < 400 && !said.length; k++) try { new Env({ vision_active: true, vision_resolution: 512 }); } catch (e) { said.push(e.name); }
    told(() => env.step());
    told(() => env.free());
    console.log(said.join());`);
  assert.equal(out, "ModuleError,ModuleError,ModuleError\n");
});

test("what needs the module says that it is not loaded", () => {
  const out = run(`
    import { Env, configKeys } from "${dist}babybench.js";
    for (const use of [() => new Env(), configKeys]) try { use(); } catch (e) { console.log(e.name, /await init/.test(e.message)); }`);
  assert.equal(out, "MissingError true\nMissingError true\n");
});

test("a view that memory has left behind is told from a wrong action", () => {
  const env = new Env({ behavior: "self_touch", scene: "crib", vision_active: false });
  env.reset(0);
  const action = env.action;
  const others = [];
  while (action.length) others.push(new Env({ vision_active: true, vision_resolution: 256 }));
  assert.throws(() => env.step(action), { name: "ArgumentError", message: /memory grew/ });
  assert.equal(env.step(env.action).info.steps, 1);
  for (const other of [env, ...others]) other.free();
});
