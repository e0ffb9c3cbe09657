// Prints what `cargo run --example checksum` prints, computed by the WebAssembly module given as argument; with `vector` or `snapshot` as
// second argument, what `cargo run --example checksum -- vector` or `... snapshot` prints.
import { readFileSync } from "node:fs";

const [path, kind] = process.argv.slice(2);
const module = new WebAssembly.Module(readFileSync(path));
const { checksum, vector_checksum, snapshot_checksum } = new WebAssembly.Instance(module, {}).exports;
const kinds = { vector: [vector_checksum, [20]], snapshot: [snapshot_checksum, ["snapshot"]] };
const [sum, lengths] = kinds[kind] ?? [checksum, [0, 10, 100, 1000]];
for (const [index, name] of ["self_touch", "hand_regard", "test_installation", "infant"].entries()) {
  for (const steps of lengths) {
    console.log(name, steps, BigInt.asUintN(64, sum(index, Number(steps) || 0)).toString(16).padStart(16, "0"));
  }
}
