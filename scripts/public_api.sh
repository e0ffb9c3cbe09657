#!/usr/bin/env bash
# Compares the public interface of the library, with all features but `internals`, with its listing in docs/public-api.txt, and prints what
# differs.
#   scripts/public_api.sh             # fails when something differs
#   scripts/public_api.sh --write     # renews the listing
# A listing that changes is a change that users of the library see: it belongs in CHANGELOG.md. Implementations that are derived, automatic
# or blanket are left out. Needs rustup, and once the network for cargo-public-api, which is built into target/tools.
set -euo pipefail
cd "$(dirname "$0")/.."
case "$*" in
  '' | --write) ;;
  *) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
target=${CARGO_TARGET_DIR:-$PWD/target}
version=0.52.0 # reads what rustdoc of Rust 1.95 writes
listing=docs/public-api.txt
features=$(scripts/public_features.sh)
tool=target/tools/bin/cargo-public-api
if [ "$("$tool" --version 2>/dev/null)" != "cargo-public-api $version" ]; then
  cargo install --quiet --locked --debug --version "$version" --root target/tools cargo-public-api # as it runs for a moment
fi

# JSON is not a stable output of rustdoc. It alone is told that it may write it, so that nothing is compiled anew: dependencies are those
# of the release profile, which .ci/run has checked by then.
wrapper=$PWD/target/tools/bin/rustdoc-json
if ! [ -x "$wrapper" ]; then # a newer one would compile anew
  printf '#!/bin/sh\nRUSTC_BOOTSTRAP=1 exec rustdoc "$@"\n' >"$wrapper"
  chmod +x "$wrapper"
fi
RUSTDOC=$wrapper cargo rustdoc --quiet --locked --release -p babybench --lib --features "$features" --target-dir "$target" -- \
  -Z unstable-options --output-format json --cap-lints allow

found=$target/public-api.txt
"$tool" public-api --rustdoc-json "$target/doc/babybench.json" -sss >"$found"
if [ "$*" = --write ]; then
  cp "$found" "$listing"
elif ! diff --unified=0 "$listing" "$found"; then
  echo "The public interface differs from $listing: run scripts/public_api.sh --write, and say in CHANGELOG.md what changes." >&2
  exit 1
fi
