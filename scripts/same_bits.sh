#!/usr/bin/env bash
# Compares the checksums of episodes with all senses, of vectors and of snapshots across instruction sets, numbers of threads and
# WebAssembly, and prints a table of Markdown. Equal checksums of snapshots are equal bytes, which each restores from the other.
#   scripts/same_bits.sh [PROGRAM [MODULE]]
# PROGRAM is the example `checksum` (target/release/examples/checksum), MODULE its WebAssembly, if there is one. A processor without AVX2 is emulated
# (Debian: qemu-user-static) and computes a step as long as this one computes fifty, so episodes end after 100 steps there. The result is in
# docs/same-bits.md.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-${CARGO_TARGET_DIR:-target}/release/examples/checksum} module=${2:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

sums() { # RUNNER THREADS LONGEST: all lines
  $1 "$program" "$2" "$3"
  $1 "$program" vector "$2"
  $1 "$program" snapshot
}
module_sums() {
  for kind in '' vector snapshot; do node examples/checksum/run.mjs "$module" $kind; done
}

sums '' 1 1000 >"$folder/measure"
echo "Commit $(git describe --always --dirty). Each line is a checksum; the measure are those of one thread on this machine."
echo
echo '| where | lines | equal |'
echo '|---|--:|--:|'
wrong=0
row() { # NAME COMMAND...: compares what a command prints
  local name=$1 lines equal
  "${@:2}" >"$folder/found"
  lines=$(wc -l <"$folder/found") equal=$(grep -cxFf "$folder/measure" "$folder/found" || true)
  if [ "$lines" != "$equal" ] || [ "$lines" -lt 15 ]; then wrong=1; fi
  echo "| $name | $lines | $equal |"
}
row 'two threads' sums '' 2 1000
row 'seven threads' sums '' 7 1000
if command -v qemu-x86_64-static >/dev/null; then
  row 'processor without AVX2 (Nehalem, emulated)' sums 'qemu-x86_64-static -cpu Nehalem' 2 100
fi
if [ -n "$module" ]; then row 'WebAssembly in node' module_sums; fi
exit $wrong
