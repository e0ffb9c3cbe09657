// Prints what `cargo run --example checksum` prints, computed by the WebAssembly module given as argument.
//   node examples/checksum/run.mjs MODULE [episode | variant | vector | snapshot | picture | keep FOLDER | restore FOLDER]
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [path, what = "episode", folder = "."] = process.argv.slice(2);
const KINDS = ["episode", "variant", "vector", "snapshot", "picture"];
const module = new WebAssembly.Module(readFileSync(path));
const { memory, memory_of, line, name, keep, restore } = new WebAssembly.Instance(module, {}).exports;

function room(length) {
  const at = memory_of(length); // may grow the memory, which replaces its buffer
  return new Uint8Array(memory.buffer, at, length);
}
const read = (length) => Buffer.from(room(length)).toString();
function print(length) {
  const text = read(length);
  if (text.startsWith("FAILED")) throw new Error(text);
  console.log(text);
}

if (what === "keep" || what === "restore") {
  for (let index = 0, length; (length = name(index)); index++) {
    const file = join(folder, read(length));
    if (what === "keep") {
      const length = keep(index);
      if (!length) throw new Error(`there is no snapshot of ${file}`);
      writeFileSync(file, room(length));
    } else {
      const bytes = readFileSync(file);
      room(bytes.length).set(bytes);
      print(restore(index));
    }
  }
} else {
  if (!KINDS.includes(what)) throw new Error(`there is no kind ${what}; ${KINDS.join(", ")}, keep or restore`);
  for (let index = 0, length; (length = line(KINDS.indexOf(what), index)); index++) print(length);
}
