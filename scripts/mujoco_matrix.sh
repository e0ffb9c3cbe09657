#!/usr/bin/env bash
# Environments of the starter kit with several releases of MuJoCo. Usage: scripts/mujoco_matrix.sh FOLDER [RELEASE...]
# FOLDER has the wheels of babybench and babybench-kit (target/python/dist, which .ci/python fills).
# Without releases: all from 3.3.0 to the newest that pip finds. Needs Python 3 with venv, and the network for wheels.
# Prints a line for each release; fails if a test fails on one of them.
set -euo pipefail
folder=$(realpath "${1:?the folder of the wheels}")
root=$(realpath "$(dirname "$0")/../python")
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
python3 -m venv "$work/venv"
pip=$work/venv/bin/pip
"$pip" install --no-compile "$folder"/babybench-*.whl "$folder"/babybench_kit-*.whl pytest gymnasium imageio packaging
if [ $# -eq 0 ]; then
  listed=$("$pip" index versions mujoco 2>/dev/null | sed -n 's/^Available versions: //p' | tr -d ' ')
  mapfile -t releases < <(tr ',' '\n' <<<"$listed" | grep -v post | sort -V | sed -n '/^3\.3\.0$/,$p')
  set -- "${releases[@]}"
fi
if [ $# -eq 0 ]; then
  echo 'mujoco_matrix: pip lists no release of MuJoCo from 3.3.0 on' >&2
  exit 1
fi
code=0
for release; do
  if ! "$pip" install --no-compile "mujoco==$release"; then
    result='cannot be installed'
  else
    # outside the source tree, so that the wheel is what is tested
    result=$(cd "$work" && "$work/venv/bin/pytest" -q -c "$root/pyproject.toml" --rootdir "$root" \
      "$root/tests/test_kit_release.py" 2>&1 | tee "$work/log" | tail -n 1) || true
  fi
  printf '%-8s %s\n' "$release" "$result"
  if [[ $result != *passed* || $result == *failed* || $result == *error* ]]; then
    code=1
    if [ -f "$work/log" ]; then grep -E '^(E  |FAILED|ERROR)' "$work/log" || true; fi
  fi
done
exit "$code"
