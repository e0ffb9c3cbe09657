"""MJCF documents for tests of :mod:`babybench.mujoco`."""

ARM = """<mujoco model="arm"><worldbody>
  <body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping=".1"/>
    <geom name="bone" type="capsule" fromto="0 0 0 .3 0 0" size=".04"/><site name="hand" pos=".3 0 0"/></body></worldbody>
  <actuator><motor name="pull" joint="shoulder" gear="2" ctrlrange="-1 1" ctrllimited="true"/></actuator>
  <keyframe><key name="up" time="2" qpos="-1.5" qvel=".5" ctrl=".25"/></keyframe></mujoco>"""
"""A hinge with a motor and a keyframe."""

ALL = """<mujoco><size nuser_body="2"/><visual><global azimuth="120" elevation="-20"/></visual>
  <default><geom friction=".8 .1 .1"/></default>
  <worldbody><geom name="floor" type="plane" size="5 5 .1"/><light pos="0 0 3" dir="0 0 -1"/>
    <body name="a" pos="0 0 .3" user="1 2"><freejoint name="root"/><geom name="ga" size=".1"/>
      <site name="sa" pos=".05 0 0" size=".01"/>
      <camera name="ca" pos="0 -1 0" xyaxes="1 0 0 0 0 1"/>
      <body name="b" pos=".2 0 0"><joint name="h" axis="0 1 0" damping=".1" stiffness="2" range="-1 1" limited="true"/>
        <geom name="gb" type="capsule" fromto="0 0 0 .3 0 0" size=".04"/><site name="sb" pos=".3 0 0" size=".01"/>
        <body name="c" pos=".3 0 0"><joint name="s" type="slide" axis="1 0 0" range="0 .2"/>
          <geom type="box" size=".05 .05 .05"/></body></body></body>
    <body name="d" pos="1 0 1"><joint name="j" axis="1 0 0"/><geom size=".1" pos="0 0 -.3"/></body></worldbody>
  <equality><joint joint1="j" polycoef=".1 0 0 0 0" active="false"/></equality>
  <tendon><fixed name="t"><joint joint="h" coef="2"/><joint joint="j" coef="-1"/></fixed></tendon>
  <actuator><motor joint="h" gear="3" ctrlrange="-1 1" ctrllimited="true"/><position joint="s" kp="20"/>
    <general joint="j" dyntype="filter" dynprm=".1" gainprm="2"/></actuator>
  <sensor><accelerometer site="sa"/><gyro site="sb"/><jointpos joint="h"/><force site="sb"/><touch site="sb"/></sensor>
  <custom><numeric name="n" data="1 2 3"/></custom>
  <keyframe><key name="first" time="1.5" qpos="0 0 1 1 0 0 0 .1 .1 .2" act=".3" ctrl=".1 .2 .3"/>
    <key qvel="0 0 0 0 0 1 1 1 1"/></keyframe></mujoco>"""
"""Some of everything: a free body, joints, limits, a tendon, an equality, activations, sensors, keyframes."""

SHAPES = """<mujoco><asset><mesh name="wedge" vertex="-.1 -.1 0 .1 -.1 0 0 .1 0 0 0 .15"/>
    <hfield name="hills" nrow="3" ncol="3" size="1 1 .1 .05" elevation="0 1 0 1 .2 1 0 1 0"/></asset>
  <worldbody><geom name="ground" type="hfield" hfield="hills"/>
    <body name="stone" pos=".1 .05 .4"><freejoint/><geom name="stone" type="mesh" mesh="wedge"/></body></worldbody></mujoco>"""
"""A mesh that falls on a height field."""
