"""Measurements of speed. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "`babybench benchmark` and python/benches measure environments")
