"""MIMo without a task."""

from babybench_kit.assets import written
from babybench_kit.tasks import dummy
from babybench_kit.tasks.dummy import MIMoDummyEnv, MIMoMuscleDummyEnv, MIMoV2DummyEnv

__all__ = ["MIMoDummyEnv", "MIMoMuscleDummyEnv", "MIMoV2DummyEnv"]

__getattr__ = written(
    __name__,
    {
        "BENCHMARK_XML": dummy.BENCHMARK_XML,
        "BENCHMARK_XML_V2": dummy.BENCHMARK_XML_V2,
        "DEMO_XML": dummy.DEMO_XML,
        "TEST_XML": dummy.TEST_XML,
    },
)
