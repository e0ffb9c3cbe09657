// Results of the native library: the file NATIVE, which `cargo run --release --example checksum` printed.
import { readFileSync } from "node:fs";

const file = process.env.NATIVE;
if (!file) throw new Error("NATIVE names no file: cargo run --release --example checksum > sums.txt, then NATIVE=sums.txt");
export const native = readFileSync(file, "utf8");

/** The lines of episodes of at most `most` steps. */
export const upTo = (/** @type {number} */ most) => native.split(/(?<=\n)/).filter((line) => Number(line.split(" ")[1]) <= most).join("");
