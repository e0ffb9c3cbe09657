// Prints what `cargo run --example checksum` prints, computed by the WebAssembly module given as argument.
import { readFileSync } from "node:fs";

const module = new WebAssembly.Module(readFileSync(process.argv[2]));
const { checksum } = new WebAssembly.Instance(module, {}).exports;
for (const [index, name] of ["self_touch", "hand_regard", "test_installation"].entries()) {
  for (const steps of [0, 10, 100, 1000]) {
    console.log(name, steps, BigInt.asUintN(64, checksum(index, steps)).toString(16).padStart(16, "0"));
  }
}
