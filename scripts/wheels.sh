#!/usr/bin/env bash
# Builds the wheels of the Python packages, each for every Python from 3.9 on, and checks that babybench compiles for the systems whose wheels
# are built on them. A wheel for the processor and the system that run this is installed and tried.
#   scripts/wheels.sh [--out FOLDER] [WHAT...]     # the wheels go to FOLDER, target/wheels by default
# WHAT, by default all but native and sdist:
#   kit                                    babybench-kit, for every system
#   manylinux-x86_64, manylinux-aarch64    Linux with glibc 2.17 or later
#   musllinux-x86_64, musllinux-aarch64    Linux with musl 1.2, as Alpine's
#   check                                  the package compiles for macOS and Windows: no linker, no Python of theirs
#   native                                 the wheel of the system that runs this: universal2 on macOS, otherwise with pip's tag
#   sdist                                  the source distributions of both packages, which are compiled once
# The linker for Linux is Zig's, with the C library that the name says. Needs rustup, Python 3 with venv, and the network for crates and
# wheels of tools. A wheel takes about ten minutes of one core.
set -euo pipefail
cd "$(dirname "$0")/.."
usage() { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }
all='kit manylinux-x86_64 manylinux-aarch64 musllinux-x86_64 musllinux-aarch64 check'
wheels=target/wheels wanted=''
while [ $# -gt 0 ]; do
  case $1 in
    --out) [ $# -gt 1 ] || usage; wheels=$2; shift ;;
    -*) usage ;;
    *) case " $all native sdist " in *" $1 "*) wanted="$wanted $1" ;; *) usage ;; esac ;;
  esac
  shift
done
mkdir -p "$wheels"
wheels=$(cd "$wheels" && pwd)
target=${CARGO_TARGET_DIR:-$PWD/target}
work=$target/wheels-work
mkdir -p "$work"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
python=python3
command -v "$python" >/dev/null || python=python # its name on Windows

programs() { # VENV: the folder of its programs
  if [ -d "$1/Scripts" ]; then echo "$1/Scripts"; else echo "$1/bin"; fi
}
tools=''
get_tools() {
  [ -z "$tools" ] || return 0
  [ -d "$work/tools" ] || "$python" -m venv "$work/tools"
  tools=$(programs "$work/tools")
  "$tools/pip" install maturin==1.16.0 ziglang==0.15.2 hatchling==1.33.0
}

hand_out() { # FILES: moves what was made to the others, and prints their paths
  local made
  for made in "$@"; do
    mv "$made" "$wheels"
    echo "$wheels/$(basename "$made")"
  done
}
wheel() { # OPTION OF MATURIN...: prints the path of the wheel
  rm -rf "$work/made"
  # A folder of its own, as it may be another compiler. Without looking at a Python, as one wheel serves them all.
  env PATH="$tools:$PATH" CARGO_TARGET_DIR="$work/build" "$tools/maturin" build --quiet --release --locked \
    --manifest-path python/Cargo.toml --out "$work/made" "$@" >&2
  hand_out "$work"/made/*.whl
}
kit() { # TARGET OF HATCHLING
  rm -rf "$work/made"
  (cd python/kit && "$tools/hatchling" build --target "$1" --directory "$work/made" >&2)
  hand_out "$work"/made/*
}
linux() { # TARGET COMPATIBILITY
  local rustc
  rustc=$(scripts/toolchain.sh "$target/toolchain" "$1")
  RUSTC=$rustc wheel --target "$1" --zig --compatibility "$2"
}
sdist() {
  rm -rf "$work/made"
  "$tools/maturin" sdist --manifest-path python/Cargo.toml --out "$work/made" >&2
  rm -rf "$work/unpacked"
  mkdir "$work/unpacked"
  tar -xzmf "$work"/made/*.tar.gz -C "$work/unpacked"
  cargo check --quiet --release --target-dir "$work/check" --manifest-path "$work"/unpacked/*/python/Cargo.toml >&2
  hand_out "$work"/made/*
  kit sdist
}
native() {
  if [ "$(uname -s)" = Darwin ]; then
    rustup target add aarch64-apple-darwin x86_64-apple-darwin >&2
    wheel --target universal2-apple-darwin
  else
    wheel
  fi
}
try() { # WHEEL: installs it in an environment of its own, and takes a step
  rm -rf "$work/tried"
  "$python" -m venv "$work/tried"
  local there
  there=$(programs "$work/tried")
  "$there/pip" install "$1"
  (cd "$work" && "$there/python" - <<'PYTHON'
import babybench

env = babybench.make("self_touch", seed=1)
env.reset(seed=0)
observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
assert env.observation_space.contains(observation) and not terminated and not truncated
print(f"  version {babybench.__version__}: a step with {observation['touch'].size} numbers of touch")
PYTHON
  )
}
here="$(uname -s)-$(uname -m)"
for what in ${wanted:-$all}; do
  started=$SECONDS made=''
  [ "$what" = check ] || get_tools
  # Bash does not stop at errors in $(...) unless it is told there.
  case $what in
    kit) made=$(set -e; kit wheel) ;;
    manylinux-*) made=$(set -e; linux "${what#*-}-unknown-linux-gnu" manylinux2014) ;;
    musllinux-*) made=$(set -e; linux "${what#*-}-unknown-linux-musl" musllinux_1_2) ;;
    native) made=$(set -e; native) ;;
    sdist) made=$(set -e; sdist) ;;
    check) scripts/other_systems.sh aarch64-apple-darwin x86_64-apple-darwin x86_64-pc-windows-msvc ;;
  esac
  [ -z "$made" ] || while read -r file; do
    echo "$what: $(basename "$file"), $(($(wc -c <"$file") / 1000)) kB ($((SECONDS - started)) s)"
  done <<<"$made"
  case $what in
    native) try "$made" ;;
    manylinux-*) [ "$here" != "Linux-${what#*-}" ] || try "$made" ;;
  esac
done
