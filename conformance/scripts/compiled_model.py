"""Compiles the assembled scenes with MuJoCo 3.3.0 and writes what the loader is compared with.

usage: python compiled_model.py [ASSETS] [OUT]      (needs mujoco==3.3.0 and numpy)
       python compiled_model.py --tasks KIT [OUT]

ASSETS holds `babybench/*.xml` and the textures they name (default: the repository's assets; the data in the repository
come from the original files, which hold the same physics and looks). Textures are replaced by tiny ones in a temporary
copy, since the model does not depend on their pixels.

Writes one file per MIMo version and scene, `compiled_<v1|v2>_<base|crib|cubes>.npz`, and `compiled_features.npz` for a
document of its own: every numeric array under MuJoCo's name, names as newline-joined UTF-8 bytes under `<kind>_name`,
the actuators of the position variant under `position_*`, and the scene text under `xml` and `position_xml`, so that the
comparison compiles the very same document.

With --tasks it writes `compiled_<task>.npz` from the scenes of MIMo's tasks in the kit, `KIT/MIMo/mimoEnv/assets/<task>_scene.xml`. Their text
is not kept: the comparison compiles the repository's own scene of the task.
"""

import pathlib
import shutil
import struct
import sys
import tempfile
import zlib

import mujoco
import numpy as np

GROUPS = ["body", "head", "eyes", "arms", "hands", "fingers", "legs", "feet"]
VERSIONED = {"fingers", "feet"}
POSE = {
    "base": 'pos="0 0 .1" euler="0 -90 0"',
    "crib": 'pos="0 0 .3" euler="0 -90 0"',
    "cubes": 'pos="0 0 .0467196" quat=".885453 -.000184209 -.464728 -.000527509"',
}
ARRAYS = """
nq nv
body_parentid body_rootid body_weldid body_jntadr body_jntnum body_dofadr body_dofnum body_geomadr body_geomnum
body_pos body_quat body_ipos body_iquat body_mass body_subtreemass body_inertia body_invweight0
jnt_type jnt_bodyid jnt_qposadr jnt_dofadr jnt_pos jnt_axis jnt_limited jnt_range jnt_margin jnt_stiffness jnt_solref
jnt_solimp jnt_group
dof_bodyid dof_jntid dof_parentid dof_armature dof_damping dof_frictionloss dof_solref dof_solimp
dof_invweight0 dof_M0
qpos0 qpos_spring
geom_type geom_size geom_bodyid geom_pos geom_quat geom_contype geom_conaffinity geom_condim geom_priority geom_friction
geom_solmix geom_solref geom_solimp geom_margin geom_gap geom_rbound geom_group geom_rgba geom_matid
site_type site_bodyid site_size site_pos site_quat site_group site_rgba site_matid
cam_mode cam_targetbodyid cam_bodyid cam_pos cam_quat cam_fovy cam_user
light_bodyid light_mode light_targetbodyid light_pos0 light_poscom0 light_dir0 light_directional light_castshadow light_pos light_dir light_ambient light_diffuse light_specular
light_attenuation light_cutoff light_exponent
mat_texid mat_rgba mat_specular mat_shininess mat_reflectance mat_emission mat_texrepeat mat_texuniform tex_type
pair_geom1 pair_geom2 pair_dim pair_solref pair_solreffriction pair_solimp pair_friction pair_margin pair_gap
exclude_signature
eq_type eq_obj1id eq_obj2id eq_data eq_active0 eq_solref eq_solimp
tendon_adr tendon_num tendon_limited tendon_range tendon_margin tendon_solref_lim tendon_solimp_lim wrap_objid wrap_prm
tendon_lengthspring tendon_stiffness tendon_damping tendon_invweight0
sensor_type sensor_objid sensor_adr
""".split()
ACTUATOR = """
actuator_trnid actuator_gear actuator_ctrllimited actuator_ctrlrange actuator_forcelimited actuator_forcerange
actuator_gainprm actuator_biastype actuator_biasprm actuator_user
""".split()
NAMES = {
    "body": ("nbody", mujoco.mjtObj.mjOBJ_BODY),
    "jnt": ("njnt", mujoco.mjtObj.mjOBJ_JOINT),
    "geom": ("ngeom", mujoco.mjtObj.mjOBJ_GEOM),
    "site": ("nsite", mujoco.mjtObj.mjOBJ_SITE),
    "cam": ("ncam", mujoco.mjtObj.mjOBJ_CAMERA),
    "light": ("nlight", mujoco.mjtObj.mjOBJ_LIGHT),
    "mat": ("nmat", mujoco.mjtObj.mjOBJ_MATERIAL),
    "tex": ("ntex", mujoco.mjtObj.mjOBJ_TEXTURE),
    "eq": ("neq", mujoco.mjtObj.mjOBJ_EQUALITY),
    "tendon": ("ntendon", mujoco.mjtObj.mjOBJ_TENDON),
    "actuator": ("nu", mujoco.mjtObj.mjOBJ_ACTUATOR),
    "sensor": ("nsensor", mujoco.mjtObj.mjOBJ_SENSOR),
}
OPTION = "timestep gravity iterations tolerance ls_iterations ls_tolerance impratio ccd_iterations ccd_tolerance".split()
STATISTIC = "meaninertia meanmass meansize extent center".split()
VISUAL = {
    "global_": "fovy offwidth offheight",
    "map": "znear zfar fogstart fogend haze shadowclip force",
    "quality": "shadowsize offsamples",
    "headlight": "active ambient diffuse specular",
}

# A document with elements that the loader understands and the scenes do not use.
FEATURES = """
<mujoco model="features">
  <compiler angle="radian" eulerseq="ZyX" texturedir="../tex"/>
  <option cone="elliptic" gravity="0 1 -9" iterations="7" ls_iterations="9" impratio="2" ccd_iterations="20"
          ccd_tolerance="1e-4" ls_tolerance="0.1"/>
  <visual>
    <global fovy="50" offwidth="320" offheight="200"/>
    <map znear="0.02" zfar="30" fogstart="2" haze="0.4"/>
    <quality offsamples="2" shadowsize="1024"/>
    <headlight ambient=".2 .2 .2" diffuse=".3 .3 .3" specular=".1 .1 .1"/>
    <rgba fog=".1 .2 .3 1" contactforce="2 -1 0 1"/>
  </visual>
  <size nuser_cam="3"/>
  <default>
    <geom rgba=".1 .2 .3 1" friction=".7"/>
    <default class="outer">
      <default class="inner"><joint stiffness="3"/><geom size=".05 .1 .15"/></default>
      <joint damping="2" armature=".01" type="slide" axis="1 2 2"/>
      <geom type="box" size=".1 .2 .3" solimp=".8 .9" priority="2" margin=".01" gap=".005" contype="6"/>
      <site type="capsule" size=".02 .03" rgba="0 1 0 1" group="2"/>
      <camera fovy="33"/>
      <light cutoff="20" exponent="3" attenuation="1 .1 .2"/>
      <pair condim="4" friction=".5 .6" solref=".01"/>
      <equality solref=".03 .9" active="false"/>
      <tendon margin=".02" solimplimit=".7" stiffness="2"/>
      <position kp="5" kv=".5" ctrlrange="-2 2"/>
      <material specular=".25"/>
    </default>
  </default>
  <asset>
    <texture name="t" type="cube" builtin="gradient" width="8" height="48" mark="random" random=".2"/>
    <material name="m" class="outer" texture="t" texrepeat="2 3" emission=".3" reflectance=".1"/>
  </asset>
  <worldbody>
    <body name="a" pos="1 2 3" euler=".1 -.2 .3">
      <joint name="a0" pos=".1 .2 .3" axis="1 1 0" range="-.3 .4" ref=".1" springref=".2" margin=".01"/>
      <joint name="a1" type="slide" axis="0 3 4" range="-1 1" frictionloss=".5" solreffriction=".03"
             solimpfriction=".6"/>
      <geom name="cap" type="capsule" fromto=".1 .2 .3 -.4 .2 .5" size=".04"/>
      <geom name="ell" type="ellipsoid" size=".1 .2 .3" pos="-.2 .1 0" axisangle="1 2 3 .7" density="700"/>
      <geom name="cyl" type="cylinder" size=".1 .2" xyaxes="1 .1 0 0 1 .2" mass="2"/>
      <geom name="bx" type="box" fromto="0 0 0 0 0 -1" size=".05"/>
      <site name="s" fromto="0 0 0 1 1 1" size=".1" type="cylinder"/>
      <camera name="look" mode="targetbody" target="b" zaxis="1 1 1" user="1 2"/>
      <light mode="track" pos="0 .1 .2" dir="1 1 -2"/>
      <light mode="trackcom" pos="0 .1 .2" dir="1 0 -2" directional="true"/>
      <light mode="targetbody" target="b" pos="0 .3 .2"/>
      <light mode="targetbodycom" target="f" pos="0 .3 .2"/>
      <light mode="targetbody"/>
      <body name="b" childclass="outer" pos=".1 0 .4" zaxis=".1 .2 -.5">
        <joint name="b0"/>
        <joint name="b1" class="inner" pos="0 .1 0"/>
        <geom name="g1"/>
        <geom name="g2" class="inner" pos=".3 0 0" quat="1 .2 0 .4"/>
        <site name="s2"/>
        <light name="l" class="outer" dir="1 2 3" diffuse="1 1 1"/>
        <camera name="fixed"/>
        <body name="c" childclass="inner" pos="0 0 .5"><geom name="g3" type="sphere" mass="1"/></body>
        <body name="d" pos="0 .2 .1" euler=".3 .2 .1">
          <inertial pos=".1 0 .2" mass="3" fullinertia=".2 .3 .4 .01 -.02 .03"/>
          <joint name="d0" type="hinge" pos=".05 .06 .07"/>
          <geom name="g4"/>
        </body>
        <body name="e"><inertial pos="0 0 .1" mass="2" diaginertia=".1 .2 .25" euler="0 .5 0"/></body>
      </body>
    </body>
    <geom name="floor" type="plane" size="0 0 1" condim="6"/>
    <body name="f" pos="-1 0 1" quat="1 1 0 0">
      <joint name="free" type="free" damping=".3" stiffness="1"/>
      <geom name="ball" size=".1" material="m" conaffinity="0" group="3" solmix="2" solref=".01"/>
    </body>
  </worldbody>
  <worldbody><body name="h"><geom name="late" size=".1" type="sphere"/></body></worldbody>
  <contact>
    <pair geom1="ball" geom2="g3" class="outer"/>
    <pair geom1="ball" geom2="cap" margin=".1" gap=".05" solreffriction=".01 2"/>
    <exclude body1="f" body2="a"/>
    <exclude body1="b" body2="f"/>
    <exclude body1="a" body2="b"/>
  </contact>
  <equality>
    <weld name="w0" body1="d" body2="f" anchor=".1 .2 .3" torquescale=".5"/>
    <weld name="w1" body1="a" relpose="1 2 3 1 1 0 0" solimp=".5"/>
    <joint name="j0" joint1="b0" joint2="a1" polycoef=".1 .2" class="outer"/>
    <joint joint1="a0"/>
  </equality>
  <tendon>
    <fixed name="t0" class="outer" range="-1 2"><joint joint="a0" coef=".5"/><joint joint="d0" coef="-2"/></fixed>
    <fixed name="t1"><joint joint="a1" coef="1"/></fixed>
    <fixed name="t2" springlength="-.5" stiffness="3"><joint joint="a0" coef="2"/></fixed>
    <fixed name="t3" class="outer" springlength=".1 .2" damping=".5"><joint joint="b0" coef="1"/></fixed>
  </tendon>
  <actuator>
    <position name="p0" joint="a0" class="outer" user="1 2"/>
    <motor name="p1" joint="a1" gear="3" forcerange="-1 2" user="4 5 6"/>
    <position name="p2" joint="d0" kp="7" ctrlrange="0 1" ctrllimited="false"/>
    <motor name="p3" joint="b0" class="outer"/>
  </actuator>
  <sensor><gyro name="y" site="s2"/><torque name="z" site="s"/><accelerometer name="x" site="s"/></sensor>
</mujoco>
"""


def scene(version, name, actuators):
    """The top document, in the order of the original kit."""
    files = ["base", f"meta_{version}"]
    files += [f"{actuators}_{g}" + (f"_{version}" if g in VERSIONED else "") for g in GROUPS]
    files += [name] if name != "base" else []
    includes = "".join(f'<include file="{f}.xml"/>' for f in files)
    return (
        f'<mujoco model="MIMo"><worldbody><body name="mimo_location" {POSE[name]}><freejoint name="mimo_location"/>'
        f'<include file="mimo_{version}.xml"/></body></worldbody>{includes}</mujoco>'
    )


def tiny_png():
    """Four by four white pixels."""
    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    rows = b"".join(b"\0" + b"\xff" * 12 for _ in range(4))
    header = struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def small_copy(assets, into):
    """Copies the assets with every image made tiny."""
    for path in assets.rglob("*"):
        target = into / path.relative_to(assets)
        if path.suffix == ".xml":
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
        elif path.suffix == ".png":
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(tiny_png())


def compile_text(root, text):
    path = root / "babybench" / "scene.xml"
    path.write_text(text)
    return mujoco.MjModel.from_xml_path(str(path))


def text_array(text):
    return np.frombuffer(text.encode(), dtype=np.uint8)


def dump(model):
    """Every array the loader fills. Integers as int32, reals as float64."""
    out = {}
    for name in ARRAYS + ACTUATOR:
        value = np.asarray(getattr(model, name))
        out[name] = value.astype(np.float64 if value.dtype.kind == "f" else np.int32)
    for name, (count, kind) in NAMES.items():
        names = [mujoco.mj_id2name(model, kind, i) or "" for i in range(getattr(model, count))]
        out[f"{name}_name"] = text_array("\n".join(names))
    for name in OPTION:
        out[f"opt_{name}"] = np.asarray(getattr(model.opt, name), dtype=np.float64)
    for name in STATISTIC:
        out[f"stat_{name}"] = np.asarray(getattr(model.stat, name), dtype=np.float64)
    for group, names in VISUAL.items():
        for name in names.split():
            out[f"vis_{group}_{name}"] = np.asarray(getattr(getattr(model.vis, group), name), dtype=np.float64)
    return out


def tasks(kit, out):
    """Compiles the kit's scenes of tasks."""
    for task in ["reach", "standup", "selfbody", "catch"]:
        model = mujoco.MjModel.from_xml_path(str(kit / "MIMo/mimoEnv/assets" / f"{task}_scene.xml"))
        path = out / f"compiled_{task}.npz"
        np.savez_compressed(path, **dump(model))
        print(path.name, path.stat().st_size)


def main():
    assert mujoco.__version__ == "3.3.0", mujoco.__version__
    if sys.argv[1:2] == ["--tasks"]:
        here = pathlib.Path(__file__).resolve().parent
        out = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else here.parent / "data"
        return tasks(pathlib.Path(sys.argv[2]), out)
    here = pathlib.Path(__file__).resolve().parent
    assets = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here.parent.parent / "assets"
    out = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else here.parent / "data"
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        small_copy(assets, root)
        arrays = dump(compile_text(root, FEATURES))
        arrays["xml"] = text_array(FEATURES)
        np.savez_compressed(out / "compiled_features.npz", **arrays)
        for version in ["v1", "v2"]:
            for name in ["base", "crib", "cubes"]:
                text, servo_text = scene(version, name, "motor"), scene(version, name, "position")
                arrays = dump(compile_text(root, text))
                servo = dump(compile_text(root, servo_text))
                # The servos change only the actuators; anything else would need its own arrays.
                for key, value in servo.items():
                    if key.startswith("actuator_"):
                        arrays["position_" + key] = value
                    else:
                        assert np.array_equal(value, arrays[key]), key
                arrays["xml"], arrays["position_xml"] = text_array(text), text_array(servo_text)
                path = out / f"compiled_{version}_{name}.npz"
                np.savez_compressed(path, **arrays)
                print(path.name, path.stat().st_size)


if __name__ == "__main__":
    main()
