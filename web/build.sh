#!/usr/bin/env bash
# Builds web/dist/: the page, all that a static host needs, and in web/dist/babybench/ the npm package.
#   web/build.sh [package]   # package: without the page
# Needs Rust, Node 20 and the Rust target wasm32-unknown-unknown, which rustup adds here where it is missing; or RUSTC_WASM, a compiler that
# has it, as scripts/toolchain.sh makes one. BINDGEN names the program of web/bindgen; without it it is built.
set -euo pipefail
cd "$(dirname "$0")/.."

# Missing tools are reported before anything is built.
missing() {
  echo "web/build.sh: $1" >&2
  exit 1
}
command -v cargo >/dev/null || missing 'cargo is missing: install Rust, https://rustup.rs'
command -v node >/dev/null || missing 'node is missing: install Node 20 or later, https://nodejs.org'
command -v npm >/dev/null || missing 'npm is missing: it comes with Node, https://nodejs.org'
node -e 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)' || missing "node is $(node --version), but must be 20 or later"
if [ -z "${RUSTC_WASM:-}" ] && ! [ -d "$(rustc --print sysroot)/lib/rustlib/wasm32-unknown-unknown" ]; then
  hint='install the Rust target wasm32-unknown-unknown, or name a compiler that has it: RUSTC_WASM=$(scripts/toolchain.sh target/toolchain wasm32-unknown-unknown) web/build.sh'
  command -v rustup >/dev/null || missing "$hint"
  rustup target add wasm32-unknown-unknown || missing "rustup cannot fetch the target: $hint"
fi

target=${CARGO_TARGET_DIR:-target}
wasm=wasm32-unknown-unknown
package=web/dist/babybench
if ! [ -d web/node_modules ]; then npm ci --prefix web --ignore-scripts --no-audit --no-fund; fi

# The modules: 128-bit vector instructions are in every browser since 2023 and in node since 16.
# One after the other: together, each would have the features of both. In that of the environments kernels are inlined because they say so;
# of the rest only what is small. Loops whose length the compiler does not know are not unrolled, nor long ones that it does know, and messages
# name sources without the folder in which they lie. That makes it a sixth smaller. Networks have their kernels in crates of others.
simd='-C target-feature=+simd128'
small="--remap-path-prefix=$PWD/="
for sources in "${CARGO_HOME:-$HOME/.cargo}"/registry/src/*/; do small+=" --remap-path-prefix=$sources="; done
for limit in inline-threshold=15 inlinehint-threshold=70 unroll-threshold=200 unroll-runtime=false; do small+=" -C llvm-args=-$limit"; done
module() { # PACKAGE PROFILE FLAGS
  env RUSTFLAGS="$3" ${RUSTC_WASM:+RUSTC="$RUSTC_WASM"} cargo build --locked --profile "$2" --target "$wasm" --target-dir "$target/wasm" -p "$1"
}
module babybench-web web "$simd $small"
module babybench-onnx web-onnx "$simd"

bindgen=${BINDGEN:-$target/testing/babybench-bindgen}
if [ -z "${BINDGEN:-}" ]; then cargo build --locked --profile testing -p babybench-bindgen; fi
rm -rf "$package"
mkdir -p "$package"
bind() { # PROFILE/MODULE NAME: JavaScript beside a module
  "$bindgen" "$target/wasm/$wasm/$1.wasm" "$package" "$2"
}
bind web/babybench_web core
bind web-onnx/babybench_onnx onnx_core

# Faces that MIMo seldom makes are fetched when they are wanted.
mkdir "$package/faces"
cp assets/tex/face_*.png "$package/faces"
rm "$package/faces/face_default.png"

# The package: its sources, and types from their comments.
cp web/package/*.js web/package/package.json web/package/README.md LICENSE-MIT LICENSE-APACHE NOTICE "$package"
web/node_modules/.bin/tsc -p web/package

if [ "${1:-}" != package ]; then node web/page/build.mjs web/dist; fi
