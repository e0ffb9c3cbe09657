#!/usr/bin/env bash
# Fetches MuJoCo's library and headers for the live tests into target/mujoco/VERSION/.
#   conformance/scripts/fetch_mujoco.sh              3.3.0, the one that babybench reproduces
#   conformance/scripts/fetch_mujoco.sh VERSION...   these; `newest` is the newest release, `later` stands for those of the report
# Needs python3, and pip in it or in the environment that fetch_python.sh makes, on 64-bit Linux. What already exists is not
# fetched again.
set -euo pipefail
cd "$(dirname "$0")/../.."
later=(3.3.7 3.4.0 3.9.0 newest)

wanted=()
for version in "${@:-3.3.0}"; do
  if [ "$version" = later ]; then wanted+=("${later[@]}"); else wanted+=("$version"); fi
done

python=''
find_pip() { # sets python
  command -v python3 >/dev/null || { echo 'there is no python3' >&2; exit 1; }
  for python in python3 target/python/bin/python; do
    if "$python" -m pip --version >/dev/null 2>&1; then return; fi
  done
  conformance/scripts/fetch_python.sh
  "$python" -m pip --version >/dev/null
}

fetch_wheel() { # REQUIREMENT: sets wheel
  if [ -z "$python" ]; then find_pip; fi
  rm -f "$temporary"/*.whl
  "$python" -m pip download --quiet --disable-pip-version-check --retries 1 --no-deps --only-binary=:all: \
    --python-version 3.11 --platform manylinux2014_x86_64 --platform manylinux_2_28_x86_64 --dest "$temporary" "$1" ||
    { echo "pip cannot fetch $1: is the network there?" >&2; exit 1; }
  wheel=$(echo "$temporary"/*.whl)
}

unpack() { # VERSION: library, headers and licenses of the wheel; fails when it has no library
  python3 - "$wheel" "$temporary/unpacked" "mujoco/libmujoco.so.$1" <<'PYTHON'
import sys, zipfile
wheel, folder, library = sys.argv[1:]
with zipfile.ZipFile(wheel) as archive:
    names = archive.namelist()
    if library not in names:
        sys.exit(1)
    archive.extractall(folder, [n for n in names if n == library or n.startswith("mujoco/include/") or "/LICENSE" in n])
PYTHON
}

mkdir -p target/mujoco
for version in "${wanted[@]}"; do
  if [ -f "target/mujoco/$version/mujoco/libmujoco.so.$version" ]; then
    echo "MuJoCo $version is there"
    continue
  fi
  # unpacked beside its place and moved there when complete
  temporary=$(mktemp -d "$PWD/target/mujoco/fetch.XXXXXX")
  trap 'rm -rf "$temporary"' EXIT
  if [ "$version" = newest ]; then requirement=mujoco; else requirement="mujoco==$version"; fi
  fetch_wheel "$requirement"
  found=$(basename "$wheel" | cut -d- -f2)
  if ! unpack "$found"; then # since 4.0 the library is in a wheel of its own
    fetch_wheel "mujoco-core==$found"
    unpack "$found"
  fi
  rm -rf "target/mujoco/$found"
  mv "$temporary/unpacked" "target/mujoco/$found"
  rm -rf "$temporary"
  echo "MuJoCo $found: target/mujoco/$found/mujoco/libmujoco.so.$found"
done
