"""Networks of Stable-Baselines3 that read only the numbers that are not 0.

A skin has thousands of sensors, but few feel anything at a time: in a rollout of MIMo about one number in eight is ever
nonzero. Numbers that are always 0 change neither the output of a first layer nor its gradient, so leaving them out gives the
same network in a third of the time. :func:`babybench.sb3.sparse` combines the two classes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional

import gymnasium
import numpy as np
import torch
from stable_baselines3.common.buffers import DictRolloutBuffer
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor, NatureCNN

MANY = 1024
"""Size of a sense from which on it pays to look for zeros."""


class SparseRolloutBuffer(DictRolloutBuffer):
    """A rollout whose batches contain, for each sense with many numbers, only those that are not always 0.

    The attribute ``columns`` of a batch's tensors lists them for :class:`SparseExtractor`.
    """

    def reset(self) -> None:
        """Allocates a rollout."""
        super().reset()
        self._columns: dict[str, torch.Tensor] = {}

    def get(self, batch_size: Optional[int] = None) -> Iterator[Any]:
        """Iterates over the batches of an epoch, in random order."""
        if self.full and not self.generator_ready:
            for key, values in self.observations.items():
                if values.ndim == 3 and values.shape[2] >= MANY:
                    columns = np.flatnonzero(values.any(axis=(0, 1)))
                    self.observations[key] = values[:, :, columns]
                    self._columns[key] = torch.as_tensor(columns, device=self.device)
        yield from super().get(batch_size)

    def _get_samples(self, *arguments: Any, **keywords: Any) -> Any:
        samples = super()._get_samples(*arguments, **keywords)
        for key, columns in self._columns.items():
            values = samples.observations[key].float()
            values.columns = columns
            samples.observations[key] = values
        return samples


class SparseExtractor(BaseFeaturesExtractor):
    """The first layer of a network, followed by tanh, for all senses together.

    It computes what a layer over Stable-Baselines3's ``CombinedExtractor`` does: images go through its ``NatureCNN``, and all
    else is one vector.
    """

    def __init__(self, observation_space: gymnasium.spaces.Dict, features_dim: int = 64) -> None:
        """Creates a layer with this many outputs."""
        super().__init__(observation_space, features_dim)
        networks, self.parts, inputs = {}, [], 0
        for key, space in observation_space.spaces.items():
            if is_image_space(space):
                networks[key] = NatureCNN(space, 256)
                width = 256
            else:
                width = gymnasium.spaces.utils.flatdim(space)
            self.parts.append((key, inputs, inputs + width))
            inputs += width
        self.eyes = torch.nn.ModuleDict(networks)
        self.layer = torch.nn.Linear(inputs, features_dim)

    def forward(self, observations: dict[str, torch.Tensor]) -> torch.Tensor:
        """Computes the outputs for a batch."""
        total = self.layer.bias
        for key, start, end in self.parts:
            values = observations[key]
            columns = getattr(values, "columns", None)
            values = self.eyes[key](values) if key in self.eyes else values.flatten(1)
            weight = self.layer.weight[:, start:end]
            if columns is None and end - start >= MANY:
                columns = values.any(0).nonzero().squeeze(1)
                values = values[:, columns]
            if columns is not None:
                weight = weight[:, columns]
            total = total + values @ weight.T
        return torch.tanh(total)
