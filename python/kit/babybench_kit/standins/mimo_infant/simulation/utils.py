"""The functions of MIMo 3's ``simulation.utils``."""

import sys

from babybench_kit import utils

sys.modules[__name__] = utils
