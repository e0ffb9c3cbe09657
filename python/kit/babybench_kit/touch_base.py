"""The interface of touch, and the types of its attributes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, ClassVar

import numpy as np
from numpy.typing import NDArray

from .replaceable import Replaceable

if TYPE_CHECKING:
    from .sensing import SensingEnv

Array = NDArray[np.float64]


class SensorMesh:
    """The sensors of a body.

    Attributes:
        vertices: Their positions, (n, 3), in the frame of the body, m.
    """

    def __init__(self, vertices: Array) -> None:
        """Takes the positions."""
        self.vertices = vertices

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(
            f"{name}: the engine knows the touch sensors of a body as points (vertices), not as a mesh; "
            "trimesh.convex.convex_hull(mesh.vertices) makes one"
        )

    def __repr__(self) -> str:
        return f"<SensorMesh of {len(self.vertices)} sensors>"


class Spacings(dict[int, float]):
    """Distances between the sensors of each body, by its id, m; a script may write to them."""

    def __init__(self, spacings: dict[int, float], written: Callable[[], None]) -> None:
        """Creates the dictionary from distances and a function that is called after a change."""
        super().__init__(spacings)
        self._written = written

    def __setitem__(self, body: int, spacing: float) -> None:
        super().__setitem__(body, spacing)
        self._written()

    def update(self, *spacings: Any, **named: Any) -> None:
        """Replaces some of the distances."""
        super().update(*spacings, **named)
        self._written()

    def __reduce__(self) -> tuple[Any, ...]:
        """Makes a copy a plain dictionary."""
        return dict, (dict(self),)


class Touch(Replaceable):
    """The interface of touch.

    Attributes:
        env: The environment.
        sensor_scales: Distance between the sensors of each body, by its id, m.
        touch_type: What a sensor reports; ``touch_function`` is the method, ``touch_size`` the number of values.
        response_type: How a force spreads; ``response_function`` is the method.
        sensor_positions: Where the sensors of each body are, (n, 3), in the frame of the body, m.
        sensor_outputs: What they felt last, (n, touch_size), N.
    """

    VALID_TOUCH_TYPES: ClassVar[dict[str, int]] = {}
    VALID_RESPONSE_FUNCTIONS: ClassVar[list[str]] = []

    def __init__(self, env: SensingEnv, touch_params: dict[str, Any]) -> None:
        """Takes the environment."""
        self.env = env
        self._core = env._core
        ids = {name: number for number, name in enumerate(env._core.names["body"])}
        missing = [body for body in touch_params["scales"] if body not in ids]
        if missing:
            raise KeyError(
                f"touch_params: the scene has no {', '.join(missing)}. MIMo v1 has the bodies of DEFAULT_TOUCH_PARAMS, v2 with "
                "fingers those of DEFAULT_TOUCH_PARAMS_V2"
            )
        scales = {ids[body]: scale for body, scale in touch_params["scales"].items()}
        self.sensor_scales: dict[int, float] = Spacings(scales, self._taken_over)
        self.touch_type: str = touch_params["touch_function"]
        self.response_type: str = touch_params["response_function"]
        for value, valid in (
            (self.touch_type, self.VALID_TOUCH_TYPES),
            (self.response_type, self.VALID_RESPONSE_FUNCTIONS),
        ):
            if value not in valid:
                raise AssertionError(f"touch: {value} does not exist; there are {', '.join(valid)}")
        self.touch_function: Callable[..., Array] = getattr(self, self.touch_type)
        self.touch_size = self.VALID_TOUCH_TYPES[self.touch_type]
        self.response_function: Callable[..., None] = getattr(self, self.response_type)
        self.sensor_positions: dict[int, Array] = {}

    @property
    def _plain(self) -> bool:
        """Whether the engine computes the output."""
        return False

    def get_touch_obs(self) -> NDArray[np.float32]:
        """Feels, and returns the output, (sensors, touch_size)."""
        raise NotImplementedError


class DiscreteTouch(Touch):
    """MIMo's touch by geoms. The kit's own does not run, so no program uses it."""

    def __init__(self, env: SensingEnv, touch_params: dict[str, Any]) -> None:
        """Refuses.

        Raises:
            NotImplementedError: Always.
        """
        raise NotImplementedError("DiscreteTouch does not run in the kit either: use TrimeshTouch")
