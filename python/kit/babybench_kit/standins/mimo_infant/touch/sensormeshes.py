"""Meshes of sensors. Not served here."""

from babybench_kit.third.refused import refuse

refuse(
    __name__,
    "the sensors of a body are env.touch.meshes[body].vertices, of which trimesh.convex.convex_hull makes a mesh",
)
