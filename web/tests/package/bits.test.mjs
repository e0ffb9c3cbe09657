// The same bits as the native library, in node and in browsers.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { FIREFOX, launch, noChromium, noFirefox } from "../launch.mjs";
import { native, upTo } from "./native.mjs";
import { root, serve } from "./server.mjs";
import { sums } from "./sums.js";

test("node", async () => {
  assert.equal(await sums((file) => readFile(join(root, "configs", file), "utf8")), native);
});

test("Chromium", { skip: noChromium }, async () => {
  const browser = await launch();
  const server = await serve();
  try {
    const page = await browser.newPage();
    await page.goto(server.page);
    await page.waitForFunction(() => "sums" in globalThis);
    assert.equal(await page.evaluate(() => /** @type {any} */ (globalThis).sums()), native);
  } finally {
    await browser.close();
    server.close();
  }
});

// Nothing drives Debian's Firefox without a further tool: the page reports by itself.
test("Firefox", { skip: noFirefox }, async () => {
  const server = await serve();
  const profile = mkdtempSync(join(tmpdir(), "firefox-"));
  const quiet = ["app.update.enabled", "browser.shell.checkDefaultBrowser", "datareporting.policy.dataSubmissionEnabled", "toolkit.telemetry.enabled"];
  writeFileSync(join(profile, "user.js"), quiet.map((key) => `user_pref("${key}", false);\n`).join(""));
  const firefox = spawn(FIREFOX, ["--headless", "--no-remote", "--profile", profile, `${server.page}?report=100`], { stdio: "ignore" });
  const failed = new Promise((_, no) => {
    firefox.on("error", no);
    firefox.on("exit", (code) => no(new Error(`Firefox ended with ${code} before the page reported`)));
  });
  try {
    assert.equal(await Promise.race([server.reported, failed]), upTo(100));
  } finally {
    failed.catch(() => {});
    firefox.kill();
    await new Promise((done) => (firefox.exitCode === null && firefox.signalCode === null ? firefox.on("exit", done) : done(undefined)));
    server.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  }
});
