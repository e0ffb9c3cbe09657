#!/usr/bin/env bash
# Prints the features that users of the library may rely on, with commas between them: all in Cargo.toml but `default`, which is some of
# them, and `internals`, which changes in any release.
#   scripts/public_features.sh
set -euo pipefail
cd "$(dirname "$0")/.."
features=$(awk '/^\[/ { within = $0 == "[features]" } within && / = / && $1 != "default" && $1 != "internals" { print $1 }' Cargo.toml | sort | paste -sd,)
shown=$(sed -n '/^\[package.metadata.docs.rs\]/,/^$/s/^features = \[\(.*\)\].*/\1/p' Cargo.toml | tr -d '" ')
if [ "$features" != "$shown" ]; then
  echo "Cargo.toml: docs.rs should show the features $features, but shows $shown: correct package.metadata.docs.rs" >&2
  exit 1
fi
echo "$features"
