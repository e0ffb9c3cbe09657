"""A window that shows one of MIMo 3's environments: ``python -m mimo_infant.simulation.simulate``."""

from babybench_kit.third.simulate import ENV_NAMES, main

__all__ = ["ENV_NAMES", "main"]

if __name__ == "__main__":
    main()
