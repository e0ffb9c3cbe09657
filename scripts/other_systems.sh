#!/usr/bin/env bash
# Checks that the library, the command line and the Python package compile for systems whose programs are not linked here: every line of
# theirs that is compiled only there is read by the compiler. Prints a line for each target.
#   scripts/other_systems.sh [TARGET...]      # all targets, or those named: scripts/other_systems.sh aarch64-apple-darwin
# Targets: Windows (x86_64-pc-windows-msvc, x86_64-pc-windows-gnu), macOS (x86_64-apple-darwin, aarch64-apple-darwin), iOS (aarch64-apple-ios)
# and Android (aarch64-linux-android), the last two for the library alone. With all features but wgpu, whose crates take longer than all others;
# GPU=yes adds it. Nothing of these systems is needed, no linker, no Python. Needs rustup, and the network for crates and standard libraries.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
desktop=(x86_64-pc-windows-msvc x86_64-pc-windows-gnu x86_64-apple-darwin aarch64-apple-darwin)
mobile=(aarch64-apple-ios aarch64-linux-android)
all=("${desktop[@]}" "${mobile[@]}")
for for in "$@"; do
  [[ " ${all[*]} " == *" $for "* ]] || { echo "scripts/other_systems.sh: there is no target $for; ${all[*]}" >&2; exit 2; }
done
[ $# -gt 0 ] || set -- "${all[@]}"

RUSTC=$(scripts/toolchain.sh "$target/toolchain" "$@")
export RUSTC
# The wheel is for every Python from 3.9 on, so it is compiled without looking at one.
export PYO3_NO_PYTHON=1

wrong=0
for for in "$@"; do
  packages=(-p babybench -p babybench-cli -p babybench-python) what='library, command line, Python package'
  features=(--features 'babybench/parallel babybench/npz babybench/onnx babybench-cli/onnx')
  if [[ " ${mobile[*]} " == *" $for "* ]]; then
    packages=(-p babybench) what='library' features=(--features 'parallel npz onnx')
  fi
  [ "${GPU:-}" != yes ] || features=(--all-features)
  started=$SECONDS result='compiles'
  # A folder of its own, as it may be another compiler.
  if ! RUSTFLAGS='-D warnings' cargo check --quiet --locked "${packages[@]}" "${features[@]}" --target "$for" --target-dir "$target/other-systems"; then
    wrong=1 result='DOES NOT COMPILE'
  fi
  echo "$for: $what: $result ($((SECONDS - started)) s)"
done
exit $wrong
