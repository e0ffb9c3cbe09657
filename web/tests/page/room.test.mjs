// A room of one's own on the page: dropped, sent in a link, and refused in words.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { roomOf, sceneOf } from "../../page/src/room.js";
import { unzip } from "../../page/src/zip.js";
import { checksum, drop, ready, start, steps, tab, until } from "./browser.mjs";

const rooms = join(import.meta.dirname, "../../../docs/guide/rooms");
const documentOf = (name) => readFileSync(join(rooms, name));
const bare = '<mujoco><include file="mimo_settings.xml"/><include file="mimo_actuators.xml"/><worldbody><body name="mimo_location" pos="0 0 .3"><freejoint name="mimo_location"/><include file="mimo.xml"/></body><geom name="floor" type="plane" size="2 2 .1"/><geom name="post" type="cylinder" size=".1 .2" pos="1 0 .2"/></worldbody></mujoco>';
let host;
before(async () => (host = await start()));
after(() => host.stop());

/** Writes an archive, compressed or not. */
function zip(files, { method = 8, flags = 0 } = {}) {
  const [parts, directory] = [[], []];
  let at = 0;
  for (const [name, content] of Object.entries(files)) {
    const [title, raw] = [Buffer.from(name), Buffer.from(content)];
    const body = method === 8 ? deflateRawSync(raw) : raw;
    const common = Buffer.alloc(26);
    common.writeUInt16LE(20, 0);
    common.writeUInt16LE(flags, 2);
    common.writeUInt16LE(method, 4);
    common.writeUInt32LE(body.length, 14);
    common.writeUInt32LE(raw.length, 18);
    common.writeUInt16LE(title.length, 22);
    parts.push(Buffer.from([0x50, 0x4b, 3, 4]), common, title, body);
    const entry = Buffer.alloc(46);
    entry.set([0x50, 0x4b, 1, 2, 20, 0]);
    entry.set(common, 6);
    entry.writeUInt32LE(at, 42);
    directory.push(entry, title);
    at += 30 + title.length + body.length;
  }
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  end.writeUInt16LE(directory.length / 2, 10);
  end.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, ...directory, end]);
}

const list = (files) => Object.entries(files).map(([path, text]) => [path, new TextEncoder().encode(text)]);

test("the scenes among files are those that include MIMo, and that nothing else includes", () => {
  const room = roomOf(list({
    "rooms/readme.txt": "hello",
    "rooms/b.xml": bare,
    "rooms/deep/a.xml": bare,
    "rooms/by_way.xml": '<mujoco><include file="part.xml"/></mujoco>',
    "rooms/part.xml": '<mujocoinclude><include file="mimo.xml"/></mujocoinclude>',
    "rooms/toys.xml": '<mujoco><!-- <include file="mimo.xml"/> --></mujoco>',
    "rooms/round.xml": '<mujoco><include file="round.xml"/></mujoco>',
  }));
  assert.deepEqual(room.scenes, ["b.xml", "by_way.xml", "deep/a.xml"]);
  assert.equal(room.yaml, null);
  const told = roomOf(list({ "a.xml": bare, "b.xml": bare, "other.yml": "scene: crib\n", "set.yml": "age: 3\nscene: 'b.xml' # mine\n" }));
  assert.equal(told.yaml, "age: 3\nscene: 'b.xml' # mine\n");
  assert.throws(() => roomOf(list({ "a.txt": "" })), /none of the files is an MJCF document/);
  assert.throws(() => roomOf(list({ "a.xml": "<mujoco/>" })), /MIMo is in none of these documents: a.xml/);
  for (const [text, scene] of [["scene: crib", null], ['scene: "my room.xml"', "my room.xml"], ["behavior: none", null], ["#scene: a.xml", null]]) assert.equal(sceneOf(text), scene);
});

test("archives that cannot be read say why", async () => {
  const all = () => true;
  const read = (bytes) => unzip(new Uint8Array(bytes), all, 1e6);
  const files = { "a.xml": bare, "b/c.xml": "<mujoco/>" };
  for (const method of [0, 8]) assert.deepEqual((await read(zip(files, { method }))).map(([name, bytes]) => [name, new TextDecoder().decode(bytes)]), Object.entries(files));
  assert.equal(await read(Buffer.from("no archive")), null);
  await assert.rejects(read(zip(files, { flags: 1 })), /encrypted/);
  await assert.rejects(read(zip(files, { method: 12 })), /a.xml has method 12/);
  const broken = zip(files);
  broken.fill(0xff, 35, 60);
  await assert.rejects(read(broken), /damaged at a.xml/);
  await assert.rejects(read(broken.subarray(broken.length - 100)), /cut off/);
  await assert.rejects(unzip(new Uint8Array(zip({ "big.xml": " ".repeat(3e6) })), all, 1 << 20), /unpacks to more than 1 MB/);
});

test("a room is dropped as an archive, goes into a link with its moment, and outlives a reload", async () => {
  const page = await host.open();
  await drop(page, "play.zip", zip({ "play/play_room.xml": documentOf("play_room.xml"), "play/play_room.yml": documentOf("play_room.yml") }));
  await until(page, () => mimo.scene.settings.scene === "play_room.xml");
  assert.equal(await page.evaluate(() => mimo.scene.settings.age), 6, "its configuration is used");
  assert.ok(await page.evaluate(() => mimo.scene.drawables.some((d) => d.name === "moon")));
  await page.locator("#where", { hasText: "in play room" }).waitFor();
  await steps(page, 40);
  const href = await page.evaluate(() => mimo.sharing.address(true));
  console.log(`link of ${href.length} characters`);
  assert.ok(href.length < 20_000);
  await steps(page, 60);
  const sum = await checksum(page);
  const there = await host.open({ hash: new URL(href).hash });
  assert.equal(await there.evaluate(() => mimo.moment.steps), 40);
  await steps(there, 60);
  assert.equal(await checksum(there), sum);
  await there.context().close();
  await page.evaluate(() => mimo.seek(40));
  await steps(page, 60);
  assert.equal(await checksum(page), sum, "its past, too");
  await page.waitForTimeout(500);
  await page.reload();
  await ready(page);
  assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "play_room.xml");
  await page.evaluate(() => mimo.change({ scene: "crib" }));
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

/** A blanket that the floor holds at its rim and MIMo's belly lifts in its middle. */
function blanket() {
  const [n, side] = [21, 0.9];
  const [vertices, faces, rim, belly] = [[], [], [], []];
  for (let r = 0; r < n; r++) {
    for (let c = 0; c < n; c++) {
      const [x, y] = [r, c].map((k) => side * (k / (n - 1) - 0.5));
      const lift = Math.max(0, 1 - Math.hypot(x, y) / (0.5 * side));
      vertices.push(x, y, 0.05 + 0.2 * lift);
      rim.push(1 - lift);
      belly.push(lift);
      if (r && c) faces.push((r - 1) * n + c - 1, r * n + c - 1, r * n + c, (r - 1) * n + c - 1, r * n + c, (r - 1) * n + c);
    }
  }
  const ids = rim.map((_, k) => k).join(" ");
  const bone = (body, z, weights) => `<bone body="${body}" bindpos="0 0 ${z}" bindquat="1 0 0 0" vertid="${ids}" vertweight="${weights.join(" ")}"/>`;
  return `<deformable><skin name="blanket" rgba=".35 .5 .8 1" vertex="${vertices.join(" ")}" face="${faces.join(" ")}">${bone("world", 0, rim)}${bone("lower_body", 0.15, belly)}</skin></deformable>`;
}

test("a skin bends with its bodies", async () => {
  const page = await host.open();
  await drop(page, "sheet.xml", Buffer.from(bare.replace("<worldbody>", `${blanket()}<worldbody>`)));
  await until(page, () => mimo.scene.drawables.some((d) => d.worn));
  const places = () => page.evaluate(() => {
    const { mesh } = mimo.stage.bodies.batches.find(({ of }) => mimo.scene.drawables[of[0]].worn);
    return [...mesh.geometry.getAttribute("position").array];
  });
  await steps(page, 1);
  const first = await places();
  await steps(page, 60);
  const then = await places();
  assert.deepEqual(then.slice(0, 3), first.slice(0, 3), "the floor holds the rim");
  const middle = 3 * 220;
  assert.ok(Math.hypot(...[0, 1, 2].map((k) => then[middle + k] - first[middle + k])) > 0.001, "MIMo moves the middle");
  if (process.env.PICTURE) await page.screenshot({ path: process.env.PICTURE });
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a folder is chosen in the tab Setup, with several rooms", async () => {
  const folder = mkdtempSync(join(tmpdir(), "babybench-room-"));
  try {
    cpSync(join(rooms, "play_room.xml"), join(folder, "play_room.xml"));
    writeFileSync(join(folder, "bare.xml"), bare);
    const page = await host.open();
    await tab(page, "Setup");
    await page.getByLabel("Choose a folder").setInputFiles(folder);
    await page.getByText("Other rooms beside it, for the setting scene: play_room.xml.").waitFor();
    assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "bare.xml");
    await page.getByRole("combobox", { name: "Room", exact: true }).selectOption("play_room.xml");
    await until(page, () => mimo.scene.drawables.some((d) => d.name === "moon"));
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("what is no room is refused in words, and what is here stays", async () => {
  const page = await host.open();
  const said = (text) => page.locator("#notices .notice", { hasText: text }).waitFor();
  await drop(page, "a.zip", Buffer.from("no archive"));
  await said("a.zip is not an archive");
  await drop(page, "toys.xml", Buffer.from("<mujoco/>"));
  await said("MIMo is in none of these documents: toys.xml");
  await drop(page, "ball.xml", Buffer.from(bare.replace('type="cylinder"', 'type="ball"')));
  await said('type="ball": not one of');
  await drop(page, "radian.xml", Buffer.from(bare.replace("<worldbody>", '<compiler angle="radian"/><worldbody>')));
  await said("radian");
  await page.evaluate(() => mimo.attempt(() => mimo.make({}, null, "scene: far_away.xml\n")));
  await said("The room far_away.xml is not here: drop its folder");
  assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "crib");
  await steps(page, 3);
  await page.context().close();
});

test("the room that the page offers to start from is one", async () => {
  const page = await host.open();
  await tab(page, "Setup");
  const waiting = page.waitForEvent("download");
  await page.getByRole("link", { name: "Save one to start from" }).click();
  const path = await (await waiting).path();
  await page.getByLabel("Drop a room here").setInputFiles({ name: "my_room.xml", mimeType: "text/xml", buffer: readFileSync(path) });
  await until(page, () => mimo.scene.settings.scene === "my_room.xml");
  await steps(page, 3);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});
