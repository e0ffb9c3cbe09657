"""MIMo 3 without a task."""

from babybench_kit.assets import scene_path as _path
from babybench_kit.assets import written
from babybench_kit.third.tasks import PATHS as _FILES
from babybench_kit.third.tasks import MIMoDummyEnv, MIMoMuscleDummyEnv, MIMoV2DummyEnv

__all__ = ["MIMoDummyEnv", "MIMoMuscleDummyEnv", "MIMoV2DummyEnv"]

_XML = ("BENCHMARK_XML", "BENCHMARK_XML_V2", "DEMO_XML", "TEST_XML")
__getattr__ = written(__name__, {name: _path(_FILES[name], 3) for name in _XML}, 3)
