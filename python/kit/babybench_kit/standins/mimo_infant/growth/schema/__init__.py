"""The rules of growth. Not served here."""

from babybench_kit.third.refused import refuse

refuse(
    __name__,
    "mimo_infant.growth.growth.get_growth_params has sizes for every age, "
    "and babybench.make(..., head_circumference=...) other measures",
)
