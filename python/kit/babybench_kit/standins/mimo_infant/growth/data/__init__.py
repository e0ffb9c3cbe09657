"""The data behind growth. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "the measures of every age are in `babybench inspect --age`")
