"""Compares the models compiled from assets/ with those from the original MIMo and BabyBench files.

    python check_assets.py ORIGINAL [--assets DIR] [--every-subset] [--verbose]

ORIGINAL is a directory that holds `babybench/*.xml` and the textures these name. Both sides are copied to a temporary
directory where every image becomes a 4x4 px one, because the original textures need gigabytes: so the pixels and sizes
of textures are the one thing that is not compared.

Compiled are both body versions, the three scenes, motors and position servos, and these subsets of the eight actuator
groups: all, none, each alone, all but each (with --every-subset all 256). Compared is every array and number of mjModel
(sizes, options, visual settings, statistics included) and every name. Prints the largest difference of each array that
differs and the number of those equal bit for bit; ends with status 1 if a difference exceeds 1e-12 or a name differs.
"""

import argparse
import itertools
import re
import shutil
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image

TOLERANCE = 1e-12
GROUPS = ("body", "head", "eyes", "arms", "hands", "fingers", "legs", "feet")
BY_VERSION = ("fingers", "feet")
POSES = {
    "base": 'pos="0 0 .1" euler="0 -90 0"',
    "crib": 'pos="0 0 .3" euler="0 -90 0"',
    "cubes": 'pos="0 0 .0467196" quat="0.885453 -0.000184209 -0.464728 -0.000527509"',
}
# Texture pixels are replaced here; paths name files, which may differ; the signature is a hash over the specification;
# njmax, nconmax and the arena's size follow from memory settings of the originals that MuJoCo calls obsolete.
NOT_COMPARED = {"tex_data", "paths", "npaths", "tex_pathadr", "nbuffer", "signature", "njmax", "nconmax", "narena"}


def document(version, scene, kind, groups):
    """The top document of one combination, which belongs next to the files it includes."""
    files = ["base.xml", f"meta_v{version}.xml"]
    files += [f"{kind}_{g}_v{version}.xml" if g in BY_VERSION else f"{kind}_{g}.xml" for g in GROUPS if g in groups]
    files += [] if scene == "base" else [f"{scene}.xml"]
    includes = "".join(f'<include file="{f}"/>' for f in files)
    return (
        f'<mujoco model="MIMo"><worldbody><body name="mimo_location" {POSES[scene]}>'
        f'<freejoint name="mimo_location"/><include file="mimo_v{version}.xml"/></body></worldbody>{includes}</mujoco>'
    )


def slim_copy(source, target):
    """Copies `source`/babybench/*.xml to `target` and puts a 4x4 px image wherever a file names a PNG."""
    directory = target / "babybench"
    directory.mkdir(parents=True)
    for xml in sorted((source / "babybench").glob("*.xml")):
        shutil.copy(xml, directory / xml.name)
        for name in re.findall(r'file\w*="([^"]+\.png)"', xml.read_text()):
            if not (source / "babybench" / name).is_file():
                sys.exit(f"{xml}: names {name}, which does not exist")
            image = directory / name
            image.parent.mkdir(parents=True, exist_ok=True)
            Image.new("RGB", (4, 4), (200, 180, 120)).save(image)
    return directory


def compile_model(directory, *combination):
    path = directory / "top_of_check_assets.xml"
    path.write_text(document(*combination))
    try:
        return mujoco.MjModel.from_xml_path(str(path))
    finally:
        path.unlink()


def fields(struct, prefix=""):
    """All numeric members of an mjModel, nested structures included, as (name, array)."""
    for name in dir(struct):
        if name.startswith("_") or name in NOT_COMPARED:
            continue
        value = getattr(struct, name)
        if callable(value):
            continue
        if isinstance(value, (bool, int, float, np.ndarray, np.generic)):
            yield prefix + name, np.asarray(value)
        elif isinstance(value, bytes):
            yield prefix + name, np.frombuffer(value, np.uint8)
        else:
            yield from fields(value, f"{prefix}{name}.")


def compare(ours, theirs):
    """(largest difference by array, arrays equal bit for bit, names that differ)"""
    a, b = dict(fields(ours)), dict(fields(theirs))
    differences, identical, names = {}, set(), []
    for name in a.keys() | b.keys():
        x, y = a.get(name), b.get(name)
        if x is None or y is None or x.shape != y.shape or x.dtype != y.dtype:
            differences[name] = float("inf")
        elif x.tobytes() == y.tobytes():
            identical.add(name)
        else:
            d = np.abs(x.astype(float) - y.astype(float))
            differences[name] = float(np.max(np.where(np.isnan(d), np.inf, d)))
    for kind in range(1, mujoco.mjtObj.mjNOBJECT):
        try:
            count = max(count_of(ours, kind), count_of(theirs, kind))
        except KeyError:
            continue
        for i in range(count):
            x, y = mujoco.mj_id2name(ours, kind, i), mujoco.mj_id2name(theirs, kind, i)
            if x != y:
                names.append(f"{mujoco.mjtObj(kind).name}[{i}]: {x} instead of {y}")
    return differences, identical, names


def count_of(model, kind):
    o = mujoco.mjtObj
    sizes = {
        o.mjOBJ_BODY: "nbody", o.mjOBJ_JOINT: "njnt", o.mjOBJ_GEOM: "ngeom", o.mjOBJ_SITE: "nsite",
        o.mjOBJ_CAMERA: "ncam", o.mjOBJ_LIGHT: "nlight", o.mjOBJ_TEXTURE: "ntex", o.mjOBJ_MATERIAL: "nmat",
        o.mjOBJ_PAIR: "npair", o.mjOBJ_EXCLUDE: "nexclude", o.mjOBJ_EQUALITY: "neq", o.mjOBJ_TENDON: "ntendon",
        o.mjOBJ_ACTUATOR: "nu", o.mjOBJ_SENSOR: "nsensor",
    }
    return getattr(model, sizes[o(kind)])


def subsets(every):
    if every:
        return [s for n in range(len(GROUPS) + 1) for s in itertools.combinations(GROUPS, n)]
    return [GROUPS, ()] + [(g,) for g in GROUPS] + [tuple(h for h in GROUPS if h != g) for g in GROUPS]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("original", type=Path)
    parser.add_argument("--assets", type=Path, default=Path(__file__).resolve().parents[2] / "assets")
    parser.add_argument("--every-subset", action="store_true", help="all 256 subsets of the actuator groups")
    parser.add_argument("--verbose", action="store_true", help="one line for each combination")
    args = parser.parse_args()

    worst, always, seen, names, count = {}, None, set(), [], 0
    with tempfile.TemporaryDirectory() as temporary:
        ours = slim_copy(args.assets, Path(temporary) / "ours")
        theirs = slim_copy(args.original, Path(temporary) / "theirs")
        for groups in subsets(args.every_subset):
            for version, scene, kind in itertools.product((1, 2), POSES, ("motor", "position")):
                combination = (version, scene, kind, groups)
                found, identical, wrong = compare(compile_model(ours, *combination), compile_model(theirs, *combination))
                label = f"v{version} {scene} {kind} [{' '.join(groups)}]"
                seen |= identical | found.keys()
                always = identical if always is None else always & identical
                for name, difference in found.items():
                    worst[name] = max(worst.get(name, 0.0), difference)
                names += [f"{label}: {w}" for w in wrong]
                count += 1
                if args.verbose:
                    print(f"{label}: largest difference {max(found.values(), default=0.0):.3g}")

    print(f"{count} combinations, {len(always)} of {len(seen)} arrays and numbers bit for bit equal in all of them")
    for name, difference in sorted(worst.items(), key=lambda item: -item[1]):
        print(f"  {name:28} {difference:.3g}")
    for line in names[:20]:
        print(f"  name: {line}")
    largest = max(worst.values(), default=0.0)
    print(f"largest difference {largest:.3g}, {len(names)} names differ")
    sys.exit(1 if largest > TOLERANCE or names else 0)


if __name__ == "__main__":
    main()
