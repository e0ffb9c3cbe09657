"""Pictures for papers. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "babybench.figures and babybench.film make figures and films")
