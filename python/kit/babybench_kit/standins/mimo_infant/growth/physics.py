"""Masses and gears of a grown MIMo. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "mimo_infant.growth.growth.get_growth_params has sizes and gears for every age")
