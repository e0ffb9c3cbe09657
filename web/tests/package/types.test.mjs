// The types as programs in TypeScript meet them, with the strictest look at the package's own files.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const folder = fileURLToPath(new URL("../../dist/babybench", import.meta.url));
const tools = fileURLToPath(new URL("../../node_modules", import.meta.url));

const PROGRAM = `
import init, { Env, ArgumentError } from "babybench";
import initOnnx, { OnnxPolicy } from "babybench/onnx";
import { connect } from "babybench/remote";
export async function main(bytes: Uint8Array) {
  await init();
  await initOnnx();
  const env = new Env({ scene: "crib" });
  const felt: Float32Array | null = env.reset(0).touch;
  const policy = new OnnxPolicy(bytes, env);
  env[Symbol.dispose]();
  const far = await connect().create({ scene: "crib" });
  const time: number = await far.call("time");
  const action: Float32Array = await far.call("sampleAction");
  const { truncated } = await far.call("step", action);
  const over: boolean = truncated;
  // @ts-expect-error there is no such method
  await far.call("fly");
  // @ts-expect-error a seed is a number
  await far.call("reset", "zero");
  // @ts-expect-error a time is no text
  const text: string = await far.call("time");
  // @ts-expect-error nor is a seed
  env.reset({ seed: 0 });
  return [felt, policy, time, over, text, ArgumentError];
}
`;

for (const lib of [["es2022", "dom"], ["es2022", "dom", "dom.iterable", "esnext"]]) {
  test(`programs check without skipLibCheck (lib ${lib.join(", ")})`, () => {
    const place = mkdtempSync(join(tmpdir(), "babybench-types-"));
    try {
      mkdirSync(join(place, "node_modules"));
      symlinkSync(folder, join(place, "node_modules/babybench"));
      writeFileSync(join(place, "main.ts"), PROGRAM);
      const compilerOptions = { strict: true, noEmit: true, skipLibCheck: false, target: "es2022", module: "nodenext", moduleResolution: "nodenext", lib, types: [], preserveSymlinks: true };
      writeFileSync(join(place, "tsconfig.json"), JSON.stringify({ compilerOptions, files: ["main.ts"] }));
      writeFileSync(join(place, "package.json"), '{ "type": "module" }');
      const { status, stdout } = spawnSync(process.execPath, [join(tools, "typescript/bin/tsc"), "-p", place], { encoding: "utf8" });
      assert.equal(stdout, "");
      assert.equal(status, 0);
    } finally {
      rmSync(place, { recursive: true });
    }
  });
}
