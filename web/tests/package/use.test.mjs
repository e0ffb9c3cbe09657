// The package as its users meet it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";
import { gzipSync } from "node:zlib";
import init, { Blueprint, configKeys, Env, loadFace, memoryBytes } from "../../dist/babybench/babybench.js";

const folder = fileURLToPath(new URL("../../dist/babybench", import.meta.url));
const crib = { behavior: "self_touch", scene: "crib", vision_active: false };

before(() => init());

test("the modules are small", () => {
  for (const [name, most, packed] of /** @type {const} */ ([["core_bg.wasm", 3.25e6, 1.39e6], ["onnx_core_bg.wasm", 3.8e6, 1.5e6]])) {
    const bytes = readFileSync(join(folder, name));
    const gzip = gzipSync(bytes, { level: 9 }).length;
    console.log(`${name}: ${bytes.length} bytes, ${gzip} gzip`);
    assert.ok(bytes.length <= most && gzip <= packed, `${name}: ${bytes.length}, ${gzip}`);
  }
});

test("a program elsewhere installs and runs it", () => {
  const place = mkdtempSync(join(tmpdir(), "babybench-"));
  const run = (/** @type {string} */ program, /** @type {string[]} */ args) => execFileSync(program, args, { cwd: place, encoding: "utf8" });
  try {
    run("npm", ["pack", folder, "--pack-destination", place]);
    const [archive] = readdirSync(place).filter((file) => file.endsWith(".tgz"));
    writeFileSync(join(place, "package.json"), '{ "type": "module" }');
    run("npm", ["install", "--offline", "--no-audit", "--no-fund", join(place, archive)]);
    writeFileSync(join(place, "main.js"), `
      import init, { Env } from "babybench";
      await init();
      const env = new Env({ behavior: "self_touch", scene: "crib", vision_active: false });
      env.reset(7);
      let felt = 0;
      for (let k = 0; k < 50; k++) {
        const { observation } = env.step(env.sampleAction());
        felt += observation.touch.reduce((sum, force) => sum + force, 0);
      }
      console.log(env.info.steps, felt > 0);`);
    assert.equal(run("node", ["main.js"]), "50 true\n");
  } finally {
    rmSync(place, { recursive: true });
  }
});

test("MIMo 3 has a chest", () => {
  for (const [behavior, nv] of [["self_touch", 55], ["hand_regard", 99]]) {
    const env = new Env({ mimo_version: 3, behavior, age: 3, vision_active: false, touch_active: false });
    env.reset(0);
    env.step();
    assert.ok(env.model.bodies.some(({ name }) => name === "chest"));
    assert.equal(env.model.nv, nv);
  }
  assert.throws(() => new Env({ mimo_version: 4 }), /mimo_version/);
});

const rooms = fileURLToPath(new URL("../../../docs/guide/rooms", import.meta.url));

test("MIMo grows by a schedule", () => {
  const env = new Env("scene: base\nbehavior: none\nvision_active: false\ntouch_active: false\nage: {0: 1, 4: 6}\n");
  env.reset(0);
  const first = env.info.age;
  for (let k = 0; k < 4; k++) env.step();
  assert.equal(env.info.age, 1, "an episode keeps its age");
  env.reset(0);
  assert.deepEqual([first, env.info.age], [1, 6]);
});

test("a room of one's own is made of files in memory", () => {
  const assets = { "rooms/play_room.xml": readFileSync(join(rooms, "play_room.xml")) };
  const settings = { scene: "rooms/play_room.xml", behavior: "self_touch", age: 6, vision_active: false };
  const blueprint = new Blueprint(settings, "play_room.yml", assets);
  const [env, other] = [blueprint.env(), new Env(settings, undefined, { "rooms/play_room.xml": assets["rooms/play_room.xml"].toString("utf8") })];
  for (const e of [env, other]) {
    e.reset(1);
    for (let k = 0; k < 20; k++) e.step();
  }
  assert.equal(env.checksum(), other.checksum(), "bytes or a text");
  assert.ok(env.model.geoms.some(({ name }) => name === "moon") && env.draw("corner", 8, 8).length === 256);
  const kept = env.snapshot();
  env.step();
  other.restore(kept);
  other.step();
  assert.equal(other.checksum(), env.checksum(), "a snapshot fits a room of the same content");
  // a picture beside the document, a part of it in a file of its own
  const parts = {
    "mine/room.xml": '<mujoco><include file="mimo_settings.xml"/><include file="mimo_actuators.xml"/><include file="wall.xml"/><worldbody><body name="mimo_location" pos="0 0 .3"><freejoint name="mimo_location"/><include file="mimo.xml"/></body><geom type="plane" size="2 2 .1"/></worldbody></mujoco>',
    "mine/wall.xml": '<mujocoinclude><worldbody><geom name="wall" type="box" size="1 .02 .3" pos="0 .8 .3"/></worldbody></mujocoinclude>',
  };
  const mine = new Env({ scene: "mine/room.xml" }, undefined, parts);
  assert.ok(mine.model.geoms.some(({ name }) => name === "wall"));
  const lacking = { "mine/room.xml": parts["mine/room.xml"] };
  assert.throws(() => new Env({ scene: "mine/room.xml" }, undefined, lacking), /mine\/wall.xml/);
  assert.throws(() => new Env({ scene: "mine/room.xml" }), /not among the assets/);
  assert.throws(() => new Env({ scene: "crib" }, undefined, { "../crib.xml": "" }), /is not a relative path/);
  assert.throws(() => new Env({ scene: "mine/mimo.xml" }, undefined, { "mine/mimo.xml": parts["mine/room.xml"] }), /mimo.xml/);
  for (const e of [env, other, mine]) e.free();
  blueprint.free();
});

test("faces are fetched when they are wanted, and change nothing but pictures", async () => {
  const seen = { ...crib, scene: "base", touch_active: false };
  const env = new Env(seen);
  env.reset(0);
  const pixels = () => env.look.textures.flatMap((faces, t) => faces.map((_, f) => Buffer.from(env.texturePixels(t, f)).toString("base64"))).join();
  const [calm, checksum, snapshot] = [pixels(), env.checksum(), env.snapshot()];
  assert.throws(() => new Env({ ...seen, facial_expression: "scared", vision_active: true }), /await loadFace\("scared"\)/);
  await assert.rejects(loadFace("sad", new Response("", { status: 404 })), { name: "MissingError", message: /answered 404/ });
  for (const { name, options } of configKeys()) if (name === "facial_expression") for (const face of options ?? []) await loadFace(face);
  env.swapFacialExpression("happy");
  assert.equal(env.config.facial_expression, "happy");
  assert.match(env.yaml, /facial_expression: happy/);
  assert.notEqual(pixels(), calm);
  assert.equal(env.checksum(), checksum);
  env.restore(snapshot);
  env.step();
  env.swapFacialExpression("default");
  assert.equal(pixels(), calm);
  const scared = new Env({ ...seen, facial_expression: "scared", vision_active: true });
  scared.reset(0);
  scared.free();
  env.free();
});

test("errors tell key and place", () => {
  assert.throws(() => new Env("scene: crib\nbehaviour: none\n", "my.yml"), { name: "ConfigError", message: "my.yml:2:1: unknown key `behaviour`; did you mean `behavior`?", key: "behaviour", line: 2, column: 1 });
  assert.throws(() => new Env({ engine: "rapier" }), /--features rapier/);
  const env = new Env(crib);
  assert.throws(() => env.step(), /call reset before step/);
  env.reset(0);
  assert.throws(() => env.step([0]), /action: it has 1 values but needs \d+/);
  assert.throws(() => env.step(env.action.map(() => NaN)), /action\[0\]: NaN is not a finite number/);
  assert.throws(() => env.lock("robot:third_elbow"), /no joint "robot:third_elbow"/);
  assert.throws(() => env.applyForce(9999, [0, 0, 1], [0, 0, 0], [0, 0, 0]), /body: 9999 is not a whole number from 0 to \d+/);
  assert.throws(() => env.draw("moon", 8, 8), /camera named "moon"/);
  assert.throws(() => env.draw("corner", 0, 8), /width: 0 is not a whole number from 1/);
  assert.throws(() => env.restore(new Uint8Array(3)), /not a snapshot/);
  env.free();
});

test("skins are bent by their bodies", () => {
  const skin = '<skin name="blanket" vertex="-1 0 .1 -1 1 .1 0 0 .4" face="0 2 1"><bone body="world" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1" vertweight="1 1"/><bone body="hip" bindpos="0 0 .3" bindquat="1 0 0 0" vertid="2" vertweight="1"/></skin>';
  const room = `<mujoco><include file="mimo_settings.xml"/><include file="mimo_actuators.xml"/><deformable>${skin}</deformable><worldbody><body name="mimo_location" pos="0 0 .3"><freejoint name="mimo_location"/><include file="mimo.xml"/></body><geom type="plane" size="2 2 .1"/></worldbody></mujoco>`;
  const env = new Env({ scene: "mine/room.xml", touch_active: false, vision_active: false }, undefined, { "mine/room.xml": room });
  env.reset(0);
  const worn = env.look.drawables.filter((drawable) => drawable.worn);
  assert.deepEqual(worn.map(({ name, shape }) => [name, shape]), [["blanket", "mesh"]]);
  const count = worn[0].mesh?.position.length ?? 0;
  const first = env.update().worn.slice();
  assert.equal(first.length, 2 * count, "places and normals");
  for (let k = 0; k < 30; k++) env.step();
  const then = env.update().worn;
  assert.deepEqual(first.slice(0, 3), new Float32Array([-1, 0, 0.1]), "where the world holds it");
  assert.deepEqual(then.slice(0, 3), first.slice(0, 3));
  const moved = [...then.subarray(0, count)].filter((value, k) => value !== first[k]);
  assert.ok(moved.length > 0, "where MIMo lies on it");
});

test("what is described fits the numbers", () => {
  const env = new Env({ behavior: "hand_regard", scene: "cubes" });
  const seen = env.reset(0);
  const { poses, bodies, felt } = env.update();
  assert.equal(poses.length, 12 * env.look.drawables.length);
  assert.equal(bodies.length, 7 * env.model.bodies.length);
  assert.equal(felt.length, env.skin.bodies.length);
  assert.equal(seen.eye_left?.length, 3 * 64 * 64, "though the memory has grown");
  assert.equal(env.model.actions.length, env.action.length);
  assert.equal(env.proprioceptionNames.at(-1)?.end, seen.proprioception.length);
  assert.deepEqual(configKeys().map((key) => key.name), Object.keys(env.config));
  for (const [t, faces] of env.look.textures.entries()) {
    faces.forEach(({ width, height }, f) => assert.equal(env.texturePixels(t, f).length, 4 * width * height));
  }
  const picture = env.draw({ lookat: [0, 0, 0.3], distance: 1.5, azimuth: 120, elevation: -20 }, 40, 30);
  assert.ok(picture.length === 4 * 40 * 30 && new Set(picture).size > 20);
  assert.ok(Array.from({ length: 1200 }, (_, k) => picture[4 * k + 3]).every((alpha) => alpha === 255));
  env.free();
});

test("a ball of another size is drawn so", () => {
  const env = new Env({ behavior: "catch" });
  const grown = (/** @type {number} */ seed) => {
    env.reset(seed);
    const { poses } = env.update();
    const lengths = env.look.drawables.map((_, i) => Math.hypot(poses[12 * i + 3], poses[12 * i + 6], poses[12 * i + 9]));
    return lengths.flatMap((length, i) => (Math.abs(length - 1) > 1e-5 ? [[i, length]] : []));
  };
  const [one, other] = [grown(0), grown(1)];
  assert.deepEqual([one.length, other.length, one[0][0]], [1, 1, other[0][0]]);
  assert.notEqual(one[0][1], other[0][1]);
  assert.match(env.model.bodies[env.look.drawables[one[0][0]].body].name, /target|ball/);
  env.free();
});

test("every sense has its view", () => {
  const bare = new Env(crib);
  const { touch_pooled, pain, eye_left, eye_left_depth } = bare.reset(0);
  assert.deepEqual([touch_pooled, pain, eye_left, eye_left_depth], [null, null, null, null]);
  bare.free();
  const env = new Env({ behavior: "self_touch", scene: "crib", touch_pooled: true, pain_active: true, pain_threshold: 0, vision_resolution: 16, vision_outputs: ["rgb", "gray", "depth", "segmentation"] });
  env.reset(0);
  for (let k = 0; k < 20; k++) env.step(env.sampleAction());
  const seen = env.observation;
  const sum = (/** @type {ArrayLike<number> | null} */ values) => Array.from(values ?? []).reduce((all, v) => all + v, 0);
  assert.ok(sum(seen.touch) > 0 && sum(seen.pain) > 0 && sum(seen.touch_pooled) > 0);
  assert.equal(seen.touch_pooled?.length, 5 * new Set(env.skin.bodies).size);
  assert.equal(seen.pain?.length, env.skin.bodies.length);
  for (const side of /** @type {const} */ (["left", "right"])) {
    const [rgb, gray, depth, geoms] = [seen[`eye_${side}`], seen[`eye_${side}_gray`], seen[`eye_${side}_depth`], seen[`eye_${side}_segmentation`]];
    assert.ok(rgb && gray && depth && geoms instanceof Int32Array);
    assert.deepEqual([rgb.length, gray.length, depth.length, geoms.length], [3 * 256, 256, 256, 256]);
    gray.forEach((v, i) => assert.ok(Math.abs(v - (0.2989 * rgb[3 * i] + 0.587 * rgb[3 * i + 1] + 0.114 * rgb[3 * i + 2])) < 2));
    geoms.forEach((geom, i) => assert.ok(geom === -1 ? depth[i] === Infinity || depth[i] > 0 : geom < env.model.geoms.length && depth[i] > 0));
  }
  env.free();
});

test("one looks through eyes as they are, and disturbs nothing", () => {
  const sharp = new Env({ ...crib, vision_active: true, vision_resolution: 32, delay_vision: 3 });
  // among cubes, as the ceiling above the crib has no edges that could be blurred
  const blurred = new Env({ behavior: "hand_regard", scene: "cubes", touch_active: false, vision_resolution: 32, vision_acuity: true, age: 1, noise_vision: 20 });
  for (const env of [sharp, blurred]) {
    env.reset(0);
    env.step(env.sampleAction());
    const [left, checksum] = [env.observation.eye_left?.slice(), env.checksum()];
    const pictures = env.lookThroughEyes();
    assert.equal(pictures.length, 2 * 4 * 32 * 32);
    assert.ok(pictures.every((v, i) => i % 4 < 3 || v === 255));
    assert.deepEqual(env.observation.eye_left, left);
    assert.equal(env.checksum(), checksum);
  }
  const own = sharp.draw("eye_left", 32, 32).slice();
  const seen = sharp.lookThroughEyes();
  assert.deepEqual(seen.slice(0, own.length), own, "sharp eyes see what a camera in their place sees");
  assert.notDeepEqual(blurred.lookThroughEyes().slice(0, own.length), blurred.draw("eye_left", 32, 32).slice());
  assert.deepEqual([sharp, blurred].map((env) => env.visionDelay), [3, 0]);
  sharp.free(), blurred.free();
  const uneven = new Env({ ...crib, age: 0, delay_by_age: true, vision_active: true, vision_resolution: 16, vision_width: 24, vision_height_right: 8, vision_fovy_left: 30 });
  assert.equal(uneven.visionDelay, 52);
  assert.deepEqual(uneven.eyeSizes, [[24, 16], [24, 8]]);
  assert.deepEqual([uneven.observation.eye_left?.length, uneven.observation.eye_right?.length], [3 * 24 * 16, 3 * 24 * 8]);
  const both = uneven.lookThroughEyes().slice();
  assert.equal(both.length, 4 * 24 * (16 + 8));
  assert.deepEqual(both.subarray(0, 4 * 24 * 16), uneven.draw("eye_left", 24, 16).slice());
  uneven.free();
});

test("a configuration goes round as text", () => {
  const one = new Blueprint({ ...crib, save_dir: "some place: #1", touch_scale: 2 });
  const other = new Blueprint(one.yaml);
  assert.deepEqual(other.config, one.config);
  assert.equal(one.config.save_dir, "some place: #1");
  const [a, b] = [one.env(), new Env(other)];
  a.reset(3), b.reset(3);
  a.step(a.sampleAction()), b.step(b.sampleAction());
  assert.equal(a.checksum(), b.checksum());
  for (const x of [a, b, one, other]) x.free();
});

test("a snapshot continues with the same bits, in another environment too", () => {
  const [env, other] = [new Env(crib), new Env(crib)];
  env.reset(1);
  env.lock("head", 0.1);
  env.applyForce(10, [0, 0, 2]);
  for (let k = 0; k < 30; k++) env.step(env.sampleAction());
  const { contacts, poses } = env.update();
  const there = [contacts.length > 0, poses.length];
  const snapshot = env.snapshot();
  other.restore(snapshot);
  const drawn = other.update();
  assert.deepEqual([drawn.contacts.length > 0, drawn.poses.length], there);
  assert.deepEqual(other.locked, env.locked);
  for (let k = 0; k < 30; k++) {
    env.step(env.sampleAction());
    other.step(other.sampleAction());
  }
  assert.equal(other.checksum(), env.checksum());
  env.free(), other.free();
});

test("a force moves a hand, and its release leaves none", () => {
  const env = new Env(crib);
  env.reset(0);
  const hand = env.model.bodies.findIndex((body) => body.name === "left_hand");
  const height = () => Number(env.view("xpos")?.[3 * hand + 2]);
  const started = height();
  for (let k = 0; k < 40; k++) {
    env.releaseForces();
    env.applyForce(hand, [0, 0, 6]);
    env.step(env.action.fill(0));
  }
  assert.ok(height() > started + 0.1, `${started} to ${height()}`);
  env.releaseForces();
  assert.ok(env.view("xfrc_applied")?.every((v) => v === 0));
  env.free();
});

test("resets and scenes take no more memory", () => {
  const env = new Env(crib);
  const scenes = /** @type {const} */ (["base", "crib", "cubes"]);
  const change = (/** @type {number} */ k) => {
    const other = new Env({ scene: scenes[k % 3], behavior: k % 2 ? "none" : "hand_regard" });
    other.reset(k);
    other.step(other.sampleAction());
    other.draw("corner", 64, 64);
    other.free();
  };
  for (let k = 0; k < 20; k++) env.reset(k);
  for (let k = 0; k < 6; k++) change(k);
  const settled = memoryBytes();
  for (let k = 0; k < 1000; k++) env.reset(k);
  for (let k = 0; k < 50; k++) change(k);
  console.log(`memory: ${(memoryBytes() / 1e6).toFixed(1)} MB`);
  assert.equal(memoryBytes(), settled);
  assert.ok(settled <= 80e6, `${settled}`); // measured: 76
  env.free();
});

test("environments that nobody holds are freed", async () => {
  setFlagsFromString("--expose-gc");
  const collect = runInNewContext("gc");
  const abandon = async () => {
    new Env(crib).reset(0);
    collect();
    await new Promise((done) => setTimeout(done, 5)); // registries are told between tasks
  };
  for (let k = 0; k < 5; k++) await abandon();
  const settled = memoryBytes();
  for (let k = 0; k < 40; k++) await abandon();
  assert.ok(memoryBytes() <= settled + 4e6, `${settled} to ${memoryBytes()}`);
});
