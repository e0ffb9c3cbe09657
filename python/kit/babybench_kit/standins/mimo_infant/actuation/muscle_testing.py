"""Calibration of muscles. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "strengths and velocities of muscles are `user` of the actuators in the MJCF files of the scene")
