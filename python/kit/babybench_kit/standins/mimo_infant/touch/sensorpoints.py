"""Points on geoms. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "the sensors of a body are env.touch.sensor_positions[body]")
