// Prints what `cargo run --example checksum` prints, computed by the WebAssembly module given as argument; with `vector` as
// second argument, what `cargo run --example checksum -- vector` prints.
import { readFileSync } from "node:fs";

const [path, kind] = process.argv.slice(2);
const module = new WebAssembly.Module(readFileSync(path));
const { checksum, vector_checksum } = new WebAssembly.Instance(module, {}).exports;
const [sum, lengths] = kind === "vector" ? [vector_checksum, [20]] : [checksum, [0, 10, 100, 1000]];
for (const [index, name] of ["self_touch", "hand_regard", "test_installation"].entries()) {
  for (const steps of lengths) {
    console.log(name, steps, BigInt.asUintN(64, sum(index, steps)).toString(16).padStart(16, "0"));
  }
}
