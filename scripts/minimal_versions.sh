#!/usr/bin/env bash
# Checks that the library, the command line and the Python package build with the oldest version of each dependency that their
# Cargo.toml allow, so that these bounds are true.
#   scripts/minimal_versions.sh
# Works in a copy of the sources, with a lock file of its own. Needs rustup, Python 3, and the network for crates.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
copy=$target/minimal-versions
rm -rf "$copy"
mkdir -p "$copy"
git ls-files -z | tar --null --files-from=- --create | tar --extract --directory "$copy"
rm "$copy/Cargo.lock"
cd "$copy"
sed -i 's|"\.ci/shared", ||' Cargo.toml # which allows any version
export RUSTC_BOOTSTRAP=1 CARGO_TARGET_DIR=$target/minimal
cargo -Z direct-minimal-versions generate-lockfile
cargo check --locked --all-features -p babybench -p babybench-cli -p babybench-python
