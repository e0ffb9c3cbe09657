"""Random edits of documents, the same in MuJoCo and in ``babybench.mujoco``; ``python spec_edits.py 10000`` compares as many."""

from __future__ import annotations

import random
import sys
from typing import Any

import numpy as np

BASE = """<mujoco model="base"><compiler angle="{angle}"/><option timestep="0.004"/>
 <default><geom friction=".7 .01 .001"/><joint damping=".2"/>
  <default class="limb"><geom size=".03" rgba=".2 .4 .6 1"/>
   <joint armature=".01" limited="true" range="-{r} {r}"/></default></default>
 <asset><texture name="flat" type="2d" builtin="flat" width="4" height="4"/>
  <material name="skin" texture="flat" rgba=".9 .8 .7 1"/>
  <mesh name="wedge" vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1"/></asset>
 <worldbody><geom name="floor" type="plane" size="2 2 .1"/><light name="lamp" pos="0 0 3"/>
  <camera name="eye" pos="0 -2 1" xyaxes="1 0 0 0 0 1"/>
  <body name="trunk" pos="0 0 .5" childclass="limb"><freejoint name="root"/>
   <geom name="trunk" type="capsule" size=".05 .1" material="skin"/>
   <site name="chest" pos="0 .05 0"/>
   <frame pos=".1 0 0" euler="0 0 {turn}"><body name="arm"><joint name="shoulder" axis="0 1 0"/>
     <geom name="arm" type="capsule" fromto="0 0 0 .2 0 0"/><site name="hand" pos=".2 0 0"/></body></frame></body>
  <body name="block" pos=".5 0 .1"><joint name="slide" type="slide" axis="1 0 0"/>
   <geom name="block" type="box" size=".05 .06 .07"/></body>
 </worldbody>
 <tendon><fixed name="string"><joint joint="shoulder" coef="1"/><joint joint="slide" coef="-.5"/></fixed></tendon>
 <actuator><motor name="push" joint="slide" gear="2"/><position name="hold" joint="shoulder" kp="5" kv=".1"/></actuator>
 <sensor><touch name="touch" site="hand"/><framepos name="where" objtype="site" objname="hand"/></sensor></mujoco>"""
LEFT = ("opt", "stat", "vis", "writable")


class Editor:
    """A document in one of both, with the choices of a seed."""

    def __init__(self, mujoco: Any, seed: int, degrees: bool | None = None) -> None:
        self.mujoco, self.draw = mujoco, random.Random(seed)
        self.degrees = self.draw.random() < 0.5 if degrees is None else degrees
        self.spec = mujoco.MjSpec.from_string(self.base()) if self.draw.random() < 0.8 else mujoco.MjSpec()
        self.spec.compiler.degree = self.degrees
        self.count = 0

    def base(self) -> str:
        degrees = self.degrees
        return BASE.format(
            angle="degree" if degrees else "radian", r=40 if degrees else 0.7, turn=30 if degrees else 0.5
        )

    def name(self, kind: str) -> str:
        self.count += 1
        return f"{kind}_{self.count}"

    def numbers(self, count: int, low: float = -1, high: float = 1) -> list[float]:
        return [round(self.draw.uniform(low, high), 3) for _ in range(count)]

    def pick(self, kind: str) -> Any:
        """Returns an element with a name; the same in both, as the lists may have another order."""
        lists = {"body": "bodies", "equality": "equalities"}
        found = [one for one in getattr(self.spec, lists.get(kind, f"{kind}s")) if one.name]
        return self.draw.choice(sorted(found, key=lambda one: str(one.name))) if found else None

    def add_body(self) -> None:
        m, body = self.mujoco, self.pick("body")
        new = body.add_body(name=self.name("body"), pos=self.numbers(3), gravcomp=self.draw.choice([0, 1]))
        if self.draw.random() < 0.5:
            new.quat = self.numbers(4, 0.1, 1)
        elif self.draw.random() < 0.5:
            new.alt.type = m.mjtOrientation.mjORIENTATION_EULER
            new.alt.euler = self.numbers(3)
        if body.name == "world" and self.draw.random() < 0.4:
            new.add_freejoint(name=self.name("free"))
        elif self.draw.random() < 0.8:
            kind = self.draw.choice([m.mjtJoint.mjJNT_HINGE, m.mjtJoint.mjJNT_SLIDE])
            joint = new.add_joint(name=self.name("joint"), type=kind, axis=self.numbers(3, 0.1, 1))
            joint.range, joint.stiffness = [-0.5, 0.5], self.draw.choice([0, 2.5])
            joint.limited = m.mjtLimited(self.draw.randrange(3))
        self.geom(new)

    def geom(self, body: Any) -> None:
        shapes = self.mujoco.mjtGeom
        shape = self.draw.choice(
            [shapes.mjGEOM_SPHERE, shapes.mjGEOM_CAPSULE, shapes.mjGEOM_BOX, shapes.mjGEOM_ELLIPSOID]
        )
        geom = body.add_geom(
            name=self.name("geom"), type=shape, size=self.numbers(3, 0.02, 0.1), pos=self.numbers(3, -0.1, 0.1)
        )
        if self.draw.random() < 0.5:
            geom.mass = round(self.draw.uniform(0.1, 2), 3)
        else:
            geom.density = 500
        geom.rgba = self.numbers(4, 0, 1)
        geom.contype, geom.condim = self.draw.choice([0, 1, 3]), self.draw.choice([1, 3, 4, 6])
        if self.draw.random() < 0.3:
            geom.friction[0] = 0.25

    def add_geom(self) -> None:
        self.geom(self.pick("body"))

    def add_frame(self) -> None:
        body = self.pick("body")
        frame = body.add_frame(name=self.name("frame"), pos=self.numbers(3), quat=self.numbers(4, 0.1, 1))
        self.geom(body)
        body.geoms[-1].set_frame(frame)

    def add_site(self) -> None:
        self.pick("body").add_site(
            name=self.name("site"), pos=self.numbers(3), size=self.numbers(3, 0.01, 0.02), group=2
        )

    def add_camera(self) -> None:
        self.pick("body").add_camera(name=self.name("camera"), pos=self.numbers(3), fovy=self.draw.randint(20, 90))

    def add_light(self) -> None:
        self.pick("body").add_light(name=self.name("light"), pos=self.numbers(3), diffuse=self.numbers(3, 0, 1))

    def add_actuator(self) -> None:
        m, joint = self.mujoco, self.pick("joint")
        if joint is None:
            return
        actuator = self.spec.add_actuator(name=self.name("actuator"), target=joint.name, trntype=m.mjtTrn.mjTRN_JOINT)
        actuator.gear[0], actuator.ctrlrange = 2.5, [-1, 2]
        actuator.ctrllimited = m.mjtLimited.mjLIMITED_TRUE
        if self.draw.random() < 0.5:
            actuator.gainprm[0], actuator.biasprm[1] = 7, -7
            actuator.biastype = m.mjtBias.mjBIAS_AFFINE

    def add_sensor(self) -> None:
        m = self.mujoco
        kind, of, objtype = self.draw.choice(
            [
                (m.mjtSensor.mjSENS_GYRO, "site", m.mjtObj.mjOBJ_SITE),
                (m.mjtSensor.mjSENS_JOINTPOS, "joint", m.mjtObj.mjOBJ_JOINT),
                (m.mjtSensor.mjSENS_FRAMEQUAT, "body", m.mjtObj.mjOBJ_BODY),
                (m.mjtSensor.mjSENS_ACTUATORFRC, "actuator", m.mjtObj.mjOBJ_ACTUATOR),
                (m.mjtSensor.mjSENS_SUBTREECOM, "body", m.mjtObj.mjOBJ_BODY),
            ]
        )
        about = self.pick(of)
        if about is None:
            return
        if of == "joint" and about.type not in (m.mjtJoint.mjJNT_HINGE, m.mjtJoint.mjJNT_SLIDE):
            return
        self.spec.add_sensor(name=self.name("sensor"), type=kind, objtype=objtype, objname=about.name, noise=0.25)

    def add_tendon(self) -> None:
        sites = [self.pick("site"), self.pick("site")]
        if None in sites or sites[0].name == sites[1].name:
            return
        tendon = self.spec.add_tendon(name=self.name("tendon"), stiffness=3, width=0.01)
        for site in sites:
            tendon.wrap_site(site.name)

    def add_equality(self) -> None:
        m, bodies = self.mujoco, [self.pick("body"), self.pick("body")]
        if bodies[0].name == bodies[1].name or "world" in (bodies[0].name, bodies[1].name):
            return
        equality = self.spec.add_equality(name=self.name("equality"), objtype=m.mjtObj.mjOBJ_BODY)
        equality.type = self.draw.choice([m.mjtEq.mjEQ_CONNECT, m.mjtEq.mjEQ_WELD])
        equality.name1, equality.name2 = bodies[0].name, bodies[1].name
        if self.draw.random() < 0.5:
            equality.data[:3] = self.numbers(3)

    def add_pair(self) -> None:
        geoms = [self.pick("geom"), self.pick("geom")]
        if None in geoms or geoms[0].name == geoms[1].name:
            return
        self.spec.add_pair(name=self.name("pair"), geomname1=geoms[0].name, geomname2=geoms[1].name, condim=4)

    def add_exclude(self) -> None:
        bodies = [self.pick("body"), self.pick("body")]
        if bodies[0].name != bodies[1].name:
            self.spec.add_exclude(name=self.name("exclude"), bodyname1=bodies[0].name, bodyname2=bodies[1].name)

    def add_material(self) -> None:
        material = self.spec.add_material(name=self.name("material"), rgba=self.numbers(4, 0, 1), shininess=0.25)
        texture = self.spec.add_texture(name=self.name("texture"), width=8, height=8)
        texture.type, texture.builtin = self.mujoco.mjtTexture.mjTEXTURE_2D, self.mujoco.mjtBuiltin.mjBUILTIN_CHECKER
        material.textures[self.mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture.name
        geom = self.pick("geom")
        if geom is not None:
            geom.material = material.name

    def change(self) -> None:
        kind = self.draw.choice(["body", "geom", "joint", "site", "actuator"])
        one = self.pick(kind)
        if one is None or one.name == "world":
            return
        if kind == "actuator":
            one.gear[0] *= 1.5
        elif kind == "body":
            one.pos[:] = self.numbers(3)
        elif kind == "geom":
            one.solimp[1], one.margin = 0.99, 0.01
        elif kind == "joint":
            one.frictionloss = 0.25 if one.type != self.mujoco.mjtJoint.mjJNT_FREE else 0
        else:
            one.pos[2] += 0.125

    def remove(self) -> None:
        kind = self.draw.choice(["sensor", "actuator", "equality", "pair", "exclude", "body", "camera", "light"])
        one = self.pick(kind)
        if one is None or one.name in ("world", "trunk"):
            return
        if kind == "body":
            self.spec.detach_body(one)
        elif kind != "actuator" or not self.spec.sensors:
            one.delete()

    def change_default(self) -> None:
        default = self.spec.find_default("limb") or self.spec.default
        default.geom.rgba = self.numbers(4, 0, 1)
        default.joint.damping = 0.75
        self.pick("body").add_site(default, name=self.name("site"))
        self.pick("body").add_geom(default, name=self.name("geom"), size=[0.05, 0.05, 0.05])

    def attach(self) -> None:
        other = Editor(self.mujoco, self.draw.randrange(1 << 30), self.degrees)
        for _ in range(2):
            other.add_body()
        body = other.pick("body")
        if body.name != "world":
            frame = self.pick("body").add_frame(pos=self.numbers(3))
            frame.attach_body(body, self.name("p") + "_", "")

    EDITS = (
        *("add_body", "add_body", "add_geom", "add_frame", "add_site", "add_camera", "add_light", "add_actuator"),
        *("add_sensor", "add_tendon", "add_equality", "add_pair", "add_exclude", "add_material", "change", "change"),
        *("remove", "change_default", "attach"),
    )

    def run(self) -> list[str]:
        done = []
        for _ in range(self.draw.randint(3, 10)):
            edit = self.draw.choice(self.EDITS)
            done.append(edit)
            getattr(self, edit)()
        return done


def differences(mine: Any, its: Any, limit: float = 0.0) -> list[str]:
    """Returns the arrays of compiled models that differ."""
    found = []
    for name in dir(mine):
        value = getattr(mine, name)
        # names of pairs and excludes are not kept
        if callable(value) or name in LEFT or name in ("names", "nnames") or name.startswith("name_"):
            continue
        other = getattr(its, name)
        if not isinstance(other, np.ndarray):
            equal = value == other
        else:
            equal = value.shape == other.shape and bool(
                (np.abs(value - other) <= limit * max(1.0, float(np.abs(other).max(initial=0)))).all()
            )
        if not equal:
            found.append(name)
    return found


def outcome(mujoco: Any, seed: int) -> tuple[Any, list[str]]:
    """Returns the compiled model, or nothing where the document is refused."""
    editor = Editor(mujoco, seed)
    edits: list[str] = []
    try:
        edits = editor.run()
        return editor.spec.compile(), edits
    except ValueError as error:
        return str(error), edits


def compare(ours: Any, theirs: Any, seed: int, limit: float) -> str:
    """Returns what differs, or nothing."""
    (its, _), (mine, edits) = outcome(theirs, seed), outcome(ours, seed)
    if isinstance(its, str) or isinstance(mine, str):
        # MuJoCo takes an element of one document for that of the other, which is refused here
        same = isinstance(mine, str) and (isinstance(its, str) or "may take for it" in mine)
        return "" if same else f"seed {seed}, {edits}: MuJoCo {str(its)[:200]!r}, here {str(mine)[:200]!r}"
    found = differences(mine, its, limit)
    return f"seed {seed}, {edits}: {found}" if found else ""


def main() -> None:
    """Compares as many documents as the command asks for, and prints a table."""
    import mujoco as theirs
    from babybench import mujoco as ours

    count = int(sys.argv[1])
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    told = []
    exact = refused = 0
    for seed in range(first, first + count):
        problem = compare(ours, theirs, seed, 1e-12)
        if problem:
            told.append(problem)
            print(problem)
            continue
        model, mine = outcome(theirs, seed)[0], outcome(ours, seed)[0]
        refused += isinstance(mine, str)
        exact += not isinstance(mine, str) and not differences(mine, model)
    print(f"| {count} | {exact} | {count - exact - refused - len(told)} | {refused} | {len(told)} |")


if __name__ == "__main__":
    main()
