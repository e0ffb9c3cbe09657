#!/usr/bin/env bash
# Makes a Python environment under target/. An existing one is not made again.
#   conformance/scripts/fetch_python.sh        target/python, for the tests: NumPy and, where there is a wheel for this
#                                              Python, MuJoCo 3.3.0
#   conformance/scripts/fetch_python.sh kit    target/python-kit, for BabyBench's Python kit: kit_requirements.txt
# Needs a Python with its module venv, and pip in either of them; for the kit one from 3.9 to 3.12.
set -euo pipefail
cd "$(dirname "$0")/../.."

kind=${1:-tests}
case $kind in
  tests) environment=target/python candidates=(python3) newest=99 ;;
  kit) environment=target/python-kit candidates=(python3 python3.12 python3.11 python3.10 python3.9) newest=12 ;;
  *) echo "$kind: nothing, or kit" >&2; exit 1 ;;
esac
if [ -f "$environment/ready" ]; then
  echo "$environment is there"
  exit
fi

python=''
for candidate in "${candidates[@]}"; do
  if "$candidate" -c "import sys; sys.exit(not (3, 9) <= sys.version_info[:2] <= (3, $newest))" 2>/dev/null; then
    python=$candidate
    break
  fi
done
if [ -z "$python" ]; then
  echo "there is no Python that fits: looked for ${candidates[*]}, from 3.9$([ $newest = 99 ] || echo " to 3.$newest")" >&2
  exit 1
fi

rm -rf "$environment"
if "$python" -m venv "$environment" >/dev/null 2>&1; then
  pip() { "$environment/bin/python" -m pip "$@"; }
  into=()
elif "$python" -m venv --without-pip "$environment" && "$python" -m pip --version >/dev/null 2>&1; then
  # Python as some systems split it up: the environment has no pip of its own, but there is one beside it
  pip() { "$python" -m pip "$@"; }
  into=(--target "$("$environment/bin/python" -c 'import site; print(site.getsitepackages()[0])')")
else
  rm -rf "$environment"
  echo 'this Python has neither venv with pip nor pip (Debian, Ubuntu: apt install python3-venv)' >&2
  exit 1
fi

install() { # REQUIREMENTS
  pip install --quiet --disable-pip-version-check --retries 1 --only-binary=:all: ${into[@]+"${into[@]}"} "$@"
}
if [ "$kind" = kit ]; then
  install --requirement conformance/scripts/kit_requirements.txt ||
    { echo 'pip cannot install conformance/scripts/kit_requirements.txt: is the network there?' >&2; exit 1; }
else
  install numpy || { echo 'pip cannot install numpy: is the network there?' >&2; exit 1; }
  install mujoco==3.3.0 || echo 'there is no MuJoCo 3.3.0 for this Python'
fi
touch "$environment/ready"
