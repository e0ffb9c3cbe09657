// Every control of the page, used once.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { start, steps, tab, until } from "./browser.mjs";

let host;
let page;
before(async () => {
  host = await start();
  page = await host.open();
});
after(() => host.stop());

const look = (read) => page.evaluate(read);

test("play, pause, step, reset and speed", async () => {
  await page.getByRole("button", { name: "Play" }).click();
  await until(page, () => mimo.moment.playing && mimo.moment.steps > 3);
  await page.getByRole("button", { name: "Pause" }).click();
  await until(page, () => !mimo.moment.playing);
  const before = await look(() => mimo.moment.steps);
  await page.getByRole("button", { name: "One step" }).click();
  await until(page, (n) => mimo.moment.steps === n + 1, before);
  await page.locator("#reset").click();
  await until(page, () => mimo.moment.steps === 0);
  await page.getByLabel("Speed").selectOption("0.25");
  assert.equal(await look(() => mimo.state.speed), 0.25);
});

test("theme, view and help", async () => {
  await page.locator("#theme").click();
  assert.equal(await look(() => document.documentElement.dataset.theme), "dark");
  await page.locator("#theme").click();
  await look(() => mimo.stage.orbit.zoom(0.5));
  await page.locator("#home").click();
  assert.ok(await look(() => mimo.stage.orbit.distance > 1));
  await page.locator("#help-open").click();
  assert.equal(await page.locator("#help a").count(), 3);
  await page.locator("#help").getByRole("button", { name: "Close" }).click();
});

test("the pointer turns, moves and zooms the view", async () => {
  const box = await page.locator("#scene").boundingBox();
  const view = () => look(() => mimo.stage.orbit.view);
  const first = await view();
  const [x, y] = [box.x + box.width - 40, box.y + box.height / 2]; // beside MIMo and what lies over the picture
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 100, y - 30, { steps: 4 });
  await page.mouse.up();
  await until(page, (azimuth) => mimo.stage.orbit.view[0] !== azimuth, first[0]);
  const turned = await view();
  await page.mouse.wheel(0, 100);
  await until(page, (d) => mimo.stage.orbit.distance !== d, turned[2]);
  await page.keyboard.down("Shift");
  await page.mouse.down();
  await page.mouse.move(x - 140, y - 60, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await until(page, (at) => String(mimo.stage.orbit.view.slice(3, 6)) !== at, String(turned.slice(3, 6)));
});

test("what the scene shows", async () => {
  await tab(page, "Watch");
  const toggled = { "Heat map of touch": () => mimo.stage.skin.visible, "All sensors as dots": () => mimo.stage.skin.uniforms.dot0.value > 0, "Contact forces as arrows": () => mimo.stage.arrows.visible, Shadows: () => mimo.stage.studio.key.castShadow, "Camera follows MIMo": () => mimo.stage.orbit.follow };
  for (const [name, read] of Object.entries(toggled)) {
    const before = await look(read);
    await page.getByLabel(name).click();
    assert.equal(await look(read), !before, name);
    await page.getByLabel(name).click();
  }
  await page.getByLabel("Contact forces as arrows").click();
  await steps(page, 30);
  assert.ok(await look(() => mimo.stage.arrows.shafts.count) > 0, "arrows are drawn");
});

test("both eyes see", async () => {
  await steps(page, 1);
  await until(page, () => [...document.querySelectorAll("section:not([hidden]) .eyes canvas")].every((c) => c.getContext("2d").getImageData(0, 0, c.width, c.height).data.some((v, i) => i % 4 < 3 && v > 0)));
});

test("signals come and go", async () => {
  const plots = page.locator(".plot");
  const before = await plots.count();
  await page.getByLabel("Add a signal").selectOption({ label: "Left elbow" });
  assert.equal(await plots.count(), before + 1);
  await steps(page, 3);
  assert.match(await plots.last().locator(".reading").innerText(), /°/);
  await page.getByRole("button", { name: "Remove Left elbow" }).click();
  assert.equal(await plots.count(), before);
});

test("every policy moves MIMo, and vigour", async () => {
  await tab(page, "Move");
  for (const [name, policy] of [["Random", "random"], ["Sine", "sine"], ["Still", "zero"], ["Babbling", "babbling"]]) {
    await page.getByLabel(name, { exact: true }).check({ force: true });
    assert.equal(await look(() => mimo.state.policy), policy);
    await steps(page, 2);
    const size = await look(() => Math.hypot(...mimo.frame.subarray(mimo.scene.layout.action, mimo.scene.layout.angles)));
    assert.equal(size > 0, policy !== "zero", name);
  }
  await page.getByLabel("Vigour").press("ArrowRight");
  assert.ok(await look(() => mimo.state.vigour > 0.6));
});

test("each slider takes its actuator, shows it, and lets it go", async () => {
  await look(() => document.querySelectorAll("#panel-move details").forEach((d) => (d.open = true)));
  const sliders = page.locator("#panel-move details input[type=range]");
  const count = await sliders.count();
  assert.equal(count, await look(() => mimo.scene.actions.length));
  for (let i = 0; i < count; i++) {
    await sliders.nth(i).focus();
    await page.keyboard.press("ArrowRight");
  }
  assert.equal(await look(() => Object.keys(mimo.state.held).length), count);
  await steps(page, 1);
  assert.ok(await look(() => Object.entries(mimo.state.held).every(([i, v]) => Math.abs(mimo.frame[mimo.scene.layout.action + Number(i)] - v) < 1e-6)));
  await sliders.first().press("Delete");
  assert.equal(await look(() => Object.keys(mimo.state.held).length), count - 1);
  await page.getByRole("button", { name: "Let all go" }).click();
  assert.equal(await look(() => Object.keys(mimo.state.held).length), 0);
});

test("locks hold a part", async () => {
  await page.getByRole("button", { name: "Lock arms" }).click();
  await page.getByRole("button", { name: "Unlock arms" }).waitFor();
  assert.ok(await look(() => mimo.scene.joints.filter((j) => j.part === "arms").every((j) => j.locked)));
  await page.getByRole("button", { name: "Unlock arms" }).click();
  await page.getByRole("button", { name: "Lock arms" }).waitFor();
});

test("a part is pulled without a pointer, at the strength that one sets", async () => {
  await page.getByLabel("Strength").press("ArrowRight");
  await page.getByLabel("Part to pull").selectOption({ label: "Left hand" });
  await page.getByRole("button", { name: "Pull up" }).click();
  await steps(page, 20);
  assert.ok(await look(() => mimo.moment.pull.force > 0));
  await page.getByRole("button", { name: "Let go" }).click();
  await until(page, () => mimo.moment.pull === null);
});

test("MIMo grows, and is the original again", async () => {
  await tab(page, "Setup");
  const tall = () => look(() => Math.max(...mimo.scene.drawables.filter((d) => d.shape === "capsule").map((d) => d.size[2])));
  const original = await tall();
  const age = page.getByLabel("Age of the body");
  await age.fill("6");
  await until(page, () => mimo.scene.settings.age === 6);
  assert.ok((await tall()) < original);
  await page.getByRole("button", { name: "Original", exact: true }).click();
  await until(page, () => mimo.scene.settings.age === null);
  assert.equal(await tall(), original);
});

test("eyes mature: acuity and foveation show in their pictures", async () => {
  const edges = async () => {
    await tab(page, "Watch");
    await steps(page, 1);
    const seen = await look(async () => mimo.world.ask("eyes"));
    const [[width, height]] = seen.sizes;
    let sum = 0;
    for (let i = 4; i < 4 * width * height; i++) if (i % (4 * width) > 3) sum += (seen.pixels[i] - seen.pixels[i - 4]) ** 2;
    await tab(page, "Setup");
    return sum;
  };
  await tab(page, "Setup");
  await page.getByRole("group", { name: "Scene" }).getByLabel("Cubes").check({ force: true });
  await until(page, () => mimo.scene.settings.scene === "cubes");
  const sharp = await edges();
  await page.getByLabel("Eyes as sharp as at MIMo’s age").check();
  await until(page, () => mimo.scene.settings.vision_acuity === true && mimo.scene.settings.vision_active === true);
  const original = await edges();
  await page.getByLabel("Age of the body").fill("1");
  await until(page, () => mimo.scene.settings.age === 1);
  const infant = await edges();
  assert.ok(infant < 0.9 * original && original < sharp, `${infant}, ${original}, ${sharp}`);
  await tab(page, "Watch");
  await until(page, () => /as sharp as at 1 month/i.test(document.querySelector("#panel-watch").textContent));
  await tab(page, "Setup");
  await page.getByLabel("Foveation", { exact: true }).fill("10");
  await until(page, () => mimo.scene.settings.vision_foveation === 10);
  const seen = await look(async () => (await mimo.world.ask("eyes")).pixels);
  await page.getByLabel("Foveation", { exact: true }).fill("0");
  await until(page, () => mimo.scene.settings.vision_foveation === 0 && mimo.scene.settings.vision_active === true);
  const flat = await look(async () => (await mimo.world.ask("eyes")).pixels);
  assert.notDeepEqual(seen, flat);
  await page.getByLabel("Eyes as sharp as at MIMo’s age").uncheck();
  await until(page, () => mimo.scene.settings.vision_acuity === false && mimo.scene.settings.vision_active === false);
  await page.getByRole("button", { name: "Original", exact: true }).click();
  await until(page, () => mimo.scene.settings.age === null);
  await page.getByRole("group", { name: "Scene" }).getByLabel("Crib").check({ force: true });
  await until(page, () => mimo.scene.settings.scene === "crib");
});

test("each eye has its own width, height and field of view", async () => {
  await page.evaluate(() => mimo.change({ vision_width: 48, vision_height: 32, vision_height_left: 24, vision_fovy_right: 100 }));
  await tab(page, "Watch");
  await steps(page, 1);
  const shown = () => page.evaluate(() => [...document.querySelectorAll("section:not([hidden]) .eyes canvas")].map((c) => [c.width, c.height, c.clientWidth / c.clientHeight]));
  await until(page, () => document.querySelector("section:not([hidden]) .eyes canvas").width === 48);
  const [right, left] = await shown();
  assert.deepEqual([right.slice(0, 2), left.slice(0, 2)], [[48, 32], [48, 24]]);
  assert.ok(Math.abs(right[2] - 1.5) < 0.05 && Math.abs(left[2] - 2) < 0.05, `${right}, ${left}: pixels are square`);
  await tab(page, "Setup");
  await page.evaluate(() => mimo.change({ vision_width: null, vision_height: null, vision_height_left: null, vision_fovy_right: null }));
  await until(page, () => mimo.scene.settings.vision_width === null);
});

test("senses and movements come late", async () => {
  await tab(page, "Setup");
  await page.getByLabel("Delay of the senses").fill("200");
  await until(page, () => mimo.scene.settings.delay_sensory === 200 && mimo.scene.settings.delay_unit === "ms");
  await page.getByLabel("Delay of movement").fill("100");
  await until(page, () => mimo.scene.settings.delay_motor === 100 && mimo.scene.settings.delay_sensory === 200);
  const after = (policy) => page.evaluate(async (p) => {
    await mimo.reset(3);
    mimo.state.policy = p;
    mimo.move();
    await mimo.world.ask("step", 15);
    return mimo.world.ask("checksum");
  }, policy);
  assert.equal(await after("random"), await after("zero"), "75 ms of an action that comes after 100 ms");
  const late = await look(async () => {
    const late = [];
    for (let k = 0; k < 10; k++) {
      late.push((await mimo.world.ask("eyes")).late);
      await mimo.world.ask("step", 10);
    }
    return late;
  });
  assert.ok(late[0] < 0.201 && late.slice(5).every((s) => Math.abs(s - 0.2) < 0.001), late.join());
  const link = await look(() => mimo.sharing.address(false));
  const other = await host.open({ hash: new URL(link).hash });
  assert.deepEqual(await other.evaluate(() => [mimo.scene.settings.delay_unit, mimo.scene.settings.delay_sensory, mimo.scene.settings.delay_motor]), ["ms", 200, 100]);
  await other.context().close();
  for (const what of ["Delay of the senses", "Delay of movement"]) await page.getByLabel(what).fill("0");
  await until(page, () => mimo.scene.settings.delay_motor === 0 && mimo.scene.settings.delay_sensory === 0);
  await look(() => Object.assign(mimo.state, { policy: "babbling" }));
});

test("tasks have scenes of their own", async () => {
  for (const task of ["reach", "standup", "selfbody", "catch", "roll_over", "mobile", "play"]) {
    await page.getByLabel("Task", { exact: true }).selectOption(task);
    await until(page, (v) => mimo.scene.settings.behavior === v, task);
    assert.ok(await page.getByRole("group", { name: "Scene" }).isHidden());
    await steps(page, 3);
    assert.ok(Number.isFinite(await look(() => mimo.moment.score.earned)));
  }
  await page.getByRole("group", { name: "Behavior" }).getByLabel("Self-touch").check({ force: true });
  await until(page, () => mimo.scene.settings.behavior === "self_touch" && mimo.scene.settings.scene === "crib");
});

test("scene, behavior, body, actuation, seed and settings", async () => {
  await tab(page, "Setup");
  for (const [group, name, key, value] of [["Scene", "Cubes", "scene", "cubes"], ["Scene", "Floor", "scene", "base"], ["Behavior", "None", "behavior", "none"], ["Body", "Five fingers (v2)", "behavior", "hand_regard"], ["Body", "Mitten hands (v1)", "behavior", "self_touch"], ["Behavior", "Hand regard", "behavior", "hand_regard"], ["Actuation", "Muscles", "actuation_model", "muscle"], ["Actuation", "Angles", "actuation_model", "positional"], ["Actuation", "Torque", "actuation_model", "spring_damper"], ["Scene", "Crib", "scene", "crib"], ["Behavior", "Self-touch", "behavior", "self_touch"]]) {
    await page.getByRole("group", { name: group }).getByLabel(name, { exact: true }).check({ force: true });
    await until(page, ([k, v]) => mimo.scene.settings[k] === v, [key, value]);
  }
  await page.getByLabel("Seed", { exact: true }).fill("7");
  await page.getByRole("button", { name: "Reset", exact: true }).last().click();
  await until(page, () => mimo.state.seed === 7);
  await page.getByRole("button", { name: "Next seed" }).click();
  await until(page, () => mimo.state.seed === 8);
  await page.getByText("Every setting").click();
  await page.getByLabel("touch_scale").fill("2");
  await page.getByLabel("touch_scale").press("Enter");
  await until(page, () => mimo.scene.settings.touch_scale === 2 && mimo.scene.skin.of.length < 3000);
  // quicker than a world is built, with one between that the library refuses: nothing else is lost, and no box jumps back
  assert.deepEqual(await page.evaluate(async () => {
    const box = (name) => [...document.querySelectorAll("#panel-setup .keys label")].find((label) => label.textContent === name).querySelector("input");
    const boxes = ["touch_eyes", "vision_active"].map(box);
    boxes[0].click();
    const refused = mimo.change({ touch_scale: -1 }).catch((e) => e.message);
    boxes[1].click();
    const seen = [];
    mimo.on("state", () => seen.push(boxes.every((b) => b.checked)));
    const message = await refused;
    await mimo.turn;
    return [/touch_scale/.test(message), seen.includes(false), mimo.asked.length];
  }), [true, false, 0]);
  await until(page, () => mimo.scene.settings.touch_eyes === true && mimo.scene.settings.vision_active === true && mimo.scene.settings.touch_scale === 2);
  await page.getByRole("group", { name: "vision_outputs" }).getByLabel("depth").check();
  await until(page, () => String(mimo.scene.settings.vision_outputs) === "rgb,depth");
  await page.getByLabel("delay_vision").fill("3");
  await page.getByLabel("delay_vision").press("Enter");
  await until(page, () => mimo.scene.settings.delay_vision === 3);
  await page.getByLabel("delay_vision").fill("");
  await page.getByLabel("delay_vision").press("Enter");
  await until(page, () => mimo.scene.settings.delay_vision === null);
  await page.getByText("As a file").click();
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save file" }).click();
  assert.match(readFileSync(await (await saved).path(), "utf8"), /touch_scale: 2/);
  await page.getByLabel("Drop a configuration").setInputFiles({ name: "a.yml", mimeType: "text/yaml", buffer: Buffer.from("scene: crib\nbehavior: self_touch\n") });
  await until(page, () => mimo.scene.settings.touch_scale === 1);
  await steps(page, 1); // so that a world at its start is a new one
  await until(page, () => mimo.moment.steps === 1);
  await page.getByRole("button", { name: "Start the simulation again" }).click();
  await until(page, () => mimo.world.alive && mimo.moment.steps === 0);
});

test("picture and video are saved", async () => {
  await tab(page, "Share");
  const picture = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save picture" }).click();
  const bytes = readFileSync(await (await picture).path());
  assert.deepEqual([...bytes.subarray(1, 4)], [...Buffer.from("PNG")]);
  assert.ok(bytes.length > 20_000, "the picture is not empty");
  await page.getByRole("button", { name: "Record video" }).click();
  await steps(page, 5);
  await page.waitForTimeout(1500);
  const video = page.waitForEvent("download");
  await page.getByRole("button", { name: "Stop and save" }).click();
  const clip = readFileSync(await (await video).path());
  assert.ok(clip.length > 1000);
});

test("a link to the settings, without a moment", async () => {
  await page.getByRole("button", { name: "Link to the settings" }).click();
  await until(page, () => /^#s=/.test(location.hash) && !location.hash.includes("m="));
});

test("nothing went wrong on the way", () => assert.deepEqual(page.errors, []));
