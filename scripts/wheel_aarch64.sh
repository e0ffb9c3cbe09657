#!/usr/bin/env bash
# Builds the Python wheel for Linux on 64-bit Arm, and runs it there: a session with every scene under an emulated processor, whose numbers must
# be those of the wheel of this processor, to the bit.
#   scripts/wheel_aarch64.sh [FOLDER]     # the wheels go to FOLDER, target/wheel by default
# scripts/wheels.sh builds it, as for a release (CONTRIBUTING.md). The emulated Python is Debian's for Arm, unpacked and not installed. Needs
# rustup, Python 3 with venv, qemu-user-static, and the network for crates, wheels and Debian's packages. Takes about a quarter of an hour.
set -euo pipefail
cd "$(dirname "$0")/.."
wheels=$(realpath -m "${1:-target/wheel}")
work=$PWD/target/wheel-aarch64
emulator=qemu-aarch64-static
if ! command -v "$emulator" >/dev/null; then echo "scripts/wheel_aarch64.sh: needs $emulator (Debian: qemu-user-static)" >&2; exit 2; fi
mkdir -p "$work" "$wheels"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1

python3 -m venv "$work/tools"
rm -rf "$work/wheels"
scripts/wheels.sh --out "$work/wheels" manylinux-x86_64 manylinux-aarch64
there=$(echo "$work"/wheels/*_aarch64.whl)
here=$(echo "$work"/wheels/*_x86_64.whl)
cp "$there" "$here" "$wheels"

# Debian's Python for Arm, unpacked: package lists of our own, as those of the system know one processor only.
root=$work/root version=$(apt-cache depends python3 | sed -n 's/.*Depends: \(python3\.[0-9]*\)$/\1/p' | head -1)
if [ ! -f "$root/complete" ]; then
  rm -rf "$root" "$work/apt"
  mkdir -p "$root" "$work/apt/lists/partial" "$work/apt/packages"
  apt=(-o APT::Architectures::=arm64 -o "Dir::State::lists=$work/apt/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o Debug::NoLocking=1 -qq)
  apt-get "${apt[@]}" update
  (cd "$work/apt/packages" && apt-get "${apt[@]}" download \
    {"$version-minimal","lib$version-minimal","lib$version-stdlib",libc6,libgcc-s1,libstdc++6,zlib1g,libexpat1,libffi8,libbz2-1.0,liblzma5,libssl3,libcrypt1,libuuid1}:arm64)
  for package in "$work"/apt/packages/*.deb; do dpkg-deb --extract "$package" "$root"; done
  touch "$root/complete"
fi

# The wheel's dependencies, for each processor.
packages() { # NAME WHEEL PLATFORM
  rm -rf "${work:?}/$1"
  "$work/tools/bin/pip" install --target "$work/$1" --only-binary :all: --implementation cp --python-version "${version#python}" \
    --platform "manylinux_2_17_$3" --platform "manylinux2014_$3" --platform "manylinux_2_28_$3" "$2"
}
packages there "$there" aarch64
packages here "$here" x86_64

cat >"$work/session.py" <<'PYTHON'
"""Prints sums of everything that is returned by environments and vectors."""

import hashlib
import pickle
import platform
import sys

import babybench
import numpy as np


def digest(value: object, into: "hashlib._Hash") -> None:
    if isinstance(value, dict):
        for key in sorted(value):
            into.update(str(key).encode())
            digest(value[key], into)
    else:
        into.update(np.ascontiguousarray(value).tobytes())


def line(name: str, *values: object) -> None:
    total = hashlib.sha256()
    for value in values:
        digest(value, total)
    print(name, total.hexdigest()[:16])


print(platform.machine(), "Python", platform.python_version(), "NumPy", np.__version__, file=sys.stderr)
for name in ["self_touch", "hand_regard", "reach", "standup", "catch"]:
    env = babybench.make(name)
    observation, _ = env.reset(seed=3)
    env.action_space.seed(3)
    line(name + " reset", observation)
    for _ in range(3):
        observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
    line(name + " step", observation, reward, terminated, truncated)
    again = pickle.loads(pickle.dumps(env))
    action = env.action_space.sample()
    one, other = env.step(action), again.step(action)
    line(name + " pickled", one[0])
    assert all(np.array_equal(one[0][key], other[0][key]) for key in one[0]), name
    env.close()
envs = babybench.VectorEnv("self_touch", num_envs=3)
observation, _ = envs.reset(seed=1)
envs.action_space.seed(1)
for _ in range(3):
    observation, reward, *_ = envs.step(envs.action_space.sample())
line("vector", observation, reward)
envs.close()
try:
    babybench.make("self_touch", frame_skip=-1)
except ValueError as error:
    print("refused:", error)
PYTHON

PYTHONPATH=$work/here "$version" -P "$work/session.py" >"$work/here.txt"
env -i HOME="$work" LANG=C.UTF-8 PYTHONHOME="$root/usr" PYTHONPATH="$work/there" \
  "$emulator" -L "$root" "$root/usr/bin/$version" -P "$work/session.py" >"$work/there.txt"
cat "$work/there.txt"
diff "$work/here.txt" "$work/there.txt"
echo "$(basename "$there"), $(wc -c <"$there") bytes: $(wc -l <"$work/there.txt") lines, all equal"
