#!/usr/bin/env bash
# Runs every test: the library, the command line and the distance to MuJoCo; the Python package from its wheel; the page and the npm package
# in node and browsers. What they compare with is fetched.
#   scripts/test.sh [rust] [python] [web]   # all three by default
#   scripts/test.sh changed                 # those that the changes against main concern, quickly: what is built stays, Python with one
#                                           # Gymnasium; a change of Python or JavaScript alone takes minutes
# Needs Rust; for Python: Python 3 with venv; for the web: Node 20. Browsers are installed where they are missing (apt).
set -euo pipefail
cd "$(dirname "$0")/.."
parts=${*:-rust python web}
if [ "$parts" = changed ]; then
  parts=$(scripts/changed.sh)
  echo "changed against main: ${parts:-nothing that tests concern}"
  export QUICK=yes
fi
for part in $parts; do
  case "$part" in
    rust) cargo test --locked --workspace --release --all-features ;;
    python) .ci/python ;;
    web) .ci/web ;;
    fuzz) fuzz/run all 20000 ;;
    *) echo "scripts/test.sh: there is no part $part; rust, python, web or changed" >&2; exit 2 ;;
  esac
done
