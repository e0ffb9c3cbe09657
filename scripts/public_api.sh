#!/usr/bin/env bash
# Compares the public interface of the library, with all features but `internals`, with its listing in docs/public-api.txt, and prints what
# differs.
#   scripts/public_api.sh             # fails when something differs
#   scripts/public_api.sh --write     # renews the listing
# A listing that changes is a change that users of the library see: it belongs in CHANGELOG.md. Implementations that are derived, automatic
# or blanket are left out. Needs rustup, and once the network for crates of scripts/public_api, which is built into target/tools.
set -euo pipefail
cd "$(dirname "$0")/.."
case "$*" in
  '' | --write) ;;
  *) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
target=${CARGO_TARGET_DIR:-$PWD/target}
listing=docs/public-api.txt
features=$(scripts/public_features.sh)
cargo build --quiet --locked --manifest-path scripts/public_api/Cargo.toml --target-dir target/tools/public-api
tool=target/tools/public-api/debug/public-api-listing

# JSON is not a stable output of rustdoc. It alone is told that it may write it, so that nothing is compiled anew: dependencies are those
# of the release profile, with the features that they have in the whole workspace, which .ci/run has checked by then. Its lints are those of
# pages, so that this is also the check of the documentation that users read.
wrapper=$PWD/target/tools/rustdoc-json
if ! [ -x "$wrapper" ]; then # a newer one would compile anew
  printf '#!/bin/sh\nRUSTC_BOOTSTRAP=1 exec rustdoc "$@"\n' >"$wrapper"
  chmod +x "$wrapper"
fi
RUSTDOC=$wrapper RUSTDOCFLAGS='-Z unstable-options --output-format json -D warnings' cargo doc --quiet --locked --release --no-deps \
  -p babybench -p shared-features --features "babybench/${features//,/,babybench/}" --target-dir "$target"

found=$target/public-api.txt
"$tool" "$target/doc/babybench.json" >"$found"
if [ "$*" = --write ]; then
  cp "$found" "$listing"
elif ! diff --unified=0 "$listing" "$found"; then
  echo "The public interface differs from $listing: run scripts/public_api.sh --write, and say in CHANGELOG.md what changes." >&2
  exit 1
fi
