"""The showroom in a window. Not served here."""

from babybench_kit.third.refused import refuse

refuse(__name__, 'gymnasium.make("MIMoShowroom-v0", render_mode="human") shows it')
