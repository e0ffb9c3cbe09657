"""Takes the stand-in for MuJoCo's bindings before MuJoCo's own, for runs that do without MuJoCo."""

from babybench_kit.standin import serve

serve(__name__)
