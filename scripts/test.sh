#!/usr/bin/env bash
# Runs every test: the library, the command line and the distance to MuJoCo; the Python package from its wheel; the page and the npm package
# in node and browsers. Every part runs, even if another one fails. Tests that this machine cannot run are ignored, with the reason. The
# summary at the end lists what passed, failed and was ignored, and how long it took; it stays in target/tests/summary.
#   scripts/test.sh [rust] [python] [web]   # all three by default
#   scripts/test.sh quick                   # before a pull request: formats, lints, and the tests of the parts that differ from main, without
#                                           # those that take minutes; keeps what is built and tests Python with one Gymnasium only
#   scripts/test.sh prepare                 # only fetches what the Rust tests compare with
# Needs Rust; for Python: Python 3 with venv; for the web: Node 20. scripts/install.sh adds a software graphics driver and browsers on Debian
# and Ubuntu if that needs no password. BABYBENCH_TESTS=required turns what is missing into a failure.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/steps.sh

# Fetches what the Rust tests compare with. What cannot be fetched makes tests ignored, with the reason, not failed.
prepare() {
  if [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && ! compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null; then
    scripts/install.sh mesa-vulkan-drivers libvulkan1 || true # llvmpipe
  fi
  conformance/scripts/fetch_python.sh || true
  conformance/scripts/fetch_mujoco.sh || true
}

rust() {
  if ! command -v cargo >/dev/null; then lack tests 'there is no cargo: https://rustup.rs'; return; fi
  prepare
  step 'build' cargo test --locked --workspace --profile testing --all-features --no-run
  if [ "$step_code" -eq 0 ]; then step 'tests' cargo test --locked --workspace --profile testing --all-features --no-fail-fast; fi
}

parts=${*:-rust python web}
case $parts in
  quick)
    export QUICK=yes
    call lints scripts/lint.sh quick
    parts=$(scripts/changed.sh)
    parts=${parts/fuzz/} # takes minutes
    echo "changed against main: ${parts:-nothing that tests concern}"
    ;;
  prepare) prepare; exit ;;
esac
for part_of_tests in $parts; do
  case $part_of_tests in
    rust | python | web | fuzz) ;;
    *) echo "scripts/test.sh: there is no part $part_of_tests; rust, python, web, quick or prepare" >&2; exit 2 ;;
  esac
done
for part_of_tests in $parts; do
  steps_of "$part_of_tests" # what `finish` tells a caller about, beside which other parts may fail
  case $part_of_tests in
    rust) rust ;;
    python) call python .ci/python ;;
    web) call web .ci/web ;;
    fuzz) step 'every target' fuzz/run all 20000 ;;
  esac
done
finish
