"""Rolling over. The module is the one that reads ``STARTING_POSITION``."""

import sys

from babybench_kit.third import roll_over

sys.modules[__name__] = roll_over
