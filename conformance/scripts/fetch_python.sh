#!/usr/bin/env bash
# Makes a Python environment for the tests in target/python: NumPy and, where there is a wheel for this Python, MuJoCo 3.3.0.
# Needs python3 with its module venv, and pip in either of them. What is there already is not made again.
set -euo pipefail
cd "$(dirname "$0")/../.."
environment=target/python
if [ -f "$environment/ready" ]; then
  echo "$environment is there"
  exit
fi
command -v python3 >/dev/null || { echo 'there is no python3' >&2; exit 1; }

rm -rf "$environment"
if python3 -m venv "$environment" >/dev/null 2>&1; then
  pip() { "$environment/bin/python" -m pip "$@"; }
  into=()
elif python3 -m venv --without-pip "$environment" && python3 -m pip --version >/dev/null 2>&1; then
  # Python as some systems split it up: the environment has no pip of its own, but there is one beside it
  pip() { python3 -m pip "$@"; }
  into=(--target "$("$environment/bin/python" -c 'import site; print(site.getsitepackages()[0])')")
else
  rm -rf "$environment"
  echo 'this Python has neither venv with pip nor pip (Debian, Ubuntu: apt install python3-venv)' >&2
  exit 1
fi

install() { # REQUIREMENT
  pip install --quiet --disable-pip-version-check --retries 1 --only-binary=:all: ${into[@]+"${into[@]}"} "$1"
}
install numpy || { echo 'pip cannot install numpy: is the network there?' >&2; exit 1; }
install mujoco==3.3.0 || echo 'there is no MuJoCo 3.3.0 for this Python'
touch "$environment/ready"
