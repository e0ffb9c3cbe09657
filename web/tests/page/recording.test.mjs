// Recordings: replayed on the page, and by `babybench replay`, with the same bits. BABYBENCH names that program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { read } from "../../page/src/npz.js";
import { start, steps, tab, until } from "./browser.mjs";

const program = process.env.BABYBENCH;
let host;
let folder;
before(async () => {
  host = await start();
  folder = mkdtempSync(join(tmpdir(), "babybench-page-"));
});
after(async () => {
  await host.stop();
  rmSync(folder, { recursive: true });
});

/** Records `n` steps from the middle of a run, and saves recording and configuration as a person would. */
async function record(page, settings, n) {
  await page.evaluate((s) => mimo.change(s), settings);
  await steps(page, 20);
  await page.evaluate(() => mimo.world.ask("record"));
  await steps(page, n);
  await tab(page, "Share");
  await until(page, () => document.querySelector("#panel-share .recording"));
  await page.getByRole("button", { name: "Stop" }).click();
  const files = {};
  for (const [button, name] of [["Save .npz", "recording.npz"], ["Save its configuration", "babybench.yml"]]) {
    const waiting = page.waitForEvent("download");
    await page.getByRole("button", { name: button }).click();
    files[name] = join(folder, `${settings.actuation_model}-${name}`);
    await (await waiting).saveAs(files[name]);
  }
  return files;
}

for (const actuation_model of ["spring_damper", "muscle", "positional"]) {
  test(`a recording replays with the same bits (${actuation_model})`, { timeout: 300_000 }, async (t) => {
    const page = await host.open();
    const files = await record(page, { scene: "crib", behavior: "self_touch", actuation_model }, 120);
    const archive = await read(new Uint8Array(readFileSync(files["recording.npz"])));
    assert.deepEqual(archive.actions.shape[0], 120);

    // dropped on a page of another configuration
    await page.evaluate(() => mimo.change({ scene: "base" }));
    await tab(page, "Share");
    await page.locator("#panel-share input[type=file]").setInputFiles(files["recording.npz"]);
    await page.getByText("It ends with the same bits.").waitFor({ timeout: 120_000 });
    assert.equal(await page.evaluate(() => mimo.scene.settings.scene), "crib");
    await page.context().close();

    if (!program) return t.diagnostic("BABYBENCH names no program: not compared with babybench replay");
    const out = join(folder, actuation_model);
    execFileSync(program, ["replay", "--config", files["babybench.yml"], "--recording", files["recording.npz"], "--compat", "api", "--out", out], { stdio: "pipe" });
    const replayed = await read(new Uint8Array(readFileSync(join(out, "replay.npz"))));
    const last = replayed.qpos.data.slice(-replayed.qpos.shape[1]);
    assert.deepEqual(new Uint8Array(last.buffer), new Uint8Array(archive.qpos_end.data.buffer), "positions after the last step");
  });
}
