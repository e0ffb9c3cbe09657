// How the page comes to its visitors: what a build needs, what is fetched, what a server sends.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { chmodSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { dist, ready, start, steps } from "./browser.mjs";
import { serve } from "../../page/serve.mjs";

const script = fileURLToPath(new URL("../../build.sh", import.meta.url));

for (const [what, programs, said] of [
  ["the Rust target", { rustc: "echo /nowhere", cargo: "exit 9", npm: "exit 9", node: "exit 0" }, /wasm32-unknown-unknown.*scripts\/toolchain\.sh/],
  ["cargo", { node: "exit 0", npm: "exit 9" }, /cargo is missing.*rustup\.rs/],
  ["node", { cargo: "exit 9", npm: "exit 9" }, /node is missing/],
  ["a new node", { cargo: "exit 9", npm: "exit 9", node: 'if [ "$1" = --version ]; then echo v18.0.0; else exit 1; fi' }, /node is v18\.0\.0, but must be 20/],
]) {
  test(`a build without ${what} says so at once`, () => {
    const place = mkdtempSync(join(tmpdir(), "babybench-build-"));
    try {
      for (const tool of ["bash", "dirname"]) symlinkSync(`/usr/bin/${tool}`, join(place, tool));
      for (const [name, body] of Object.entries(programs)) {
        writeFileSync(join(place, name), `#!/usr/bin/env bash\n${body}\n`.replace("/usr/bin/env bash", "/bin/sh"));
        chmodSync(join(place, name), 0o755);
      }
      const { status, stderr } = spawnSync("/bin/bash", [script], { env: { PATH: place }, encoding: "utf8" });
      assert.equal(status, 1, stderr);
      assert.match(stderr, said);
    } finally {
      rmSync(place, { recursive: true });
    }
  });
}

test("on a host without validators nothing is fetched twice, in a visit and in the next", async () => {
  /** @type {string[]} */
  const asked = [];
  const host = await start({ bare: true, seen: (path) => asked.push(path) });
  try {
    const page = await host.open({ query: "" });
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(() => navigator.serviceWorker.controller);
    const twice = asked.filter((path, i) => !path.endsWith("sw.js") && asked.indexOf(path) !== i);
    assert.deepEqual(twice, [], "in the first visit");
    asked.length = 0;
    await page.reload();
    await ready(page);
    await steps(page, 2);
    assert.deepEqual(asked.filter((path) => !path.endsWith("sw.js")), [], "in the second");
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    await host.stop();
  }
});

test("the server of the repository compresses, sends validators, and survives wrong addresses", async () => {
  const server = await serve(dist);
  try {
    const answer = await fetch(`${server.url}main.js`, { headers: { "accept-encoding": "br" } });
    assert.equal(answer.headers.get("content-encoding"), "br");
    assert.ok(Number(answer.headers.get("content-length")) < 0.35 * (await answer.text()).length);
    const again = await fetch(`${server.url}main.js`, { headers: { "if-none-match": String(answer.headers.get("etag")) } });
    assert.equal(again.status, 304);
    const plain = await fetch(`${server.url}page.css`, { headers: { "accept-encoding": "identity" } });
    assert.equal(plain.headers.get("content-encoding"), null);
    for (const path of ["%", "..%2f..%2fpackage.json", "nothing", "%00"]) assert.equal((await fetch(server.url + path)).status, 404, path);
    assert.equal((await fetch(server.url)).headers.get("content-type"), "text/html; charset=utf-8");
  } finally {
    server.close();
  }
});
