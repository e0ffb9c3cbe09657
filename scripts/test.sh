#!/usr/bin/env bash
# Runs every test: the library, the command line and the distance to MuJoCo; the Python package from its wheel; the page and the npm package
# in node and browsers. What they compare with is fetched.
#   scripts/test.sh [rust] [python] [web]   # all three by default
# Needs Rust; for Python: Python 3 with venv; for the web: Node 20. Browsers are installed where they are missing (apt).
set -euo pipefail
cd "$(dirname "$0")/.."
for what in "${@:-rust python web}"; do
  for part in $what; do
    case "$part" in
      rust) cargo test --locked --workspace --release --all-features ;;
      python) .ci/python ;;
      web) .ci/web ;;
      *) echo "scripts/test.sh: there is no part $part; rust, python or web" >&2; exit 2 ;;
    esac
  done
done
