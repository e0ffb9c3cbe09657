"""A window on a scene. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, "`babybench view` shows scenes at any age")
