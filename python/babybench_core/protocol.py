"""Protocols: experiments with infants, and what MIMo does beside published numbers.

``babybench protocol`` is the same on the command line::

    from babybench import protocol

    protocol.names()                                      # pull_to_sit, supported_sit, kick, self_touch, roll_over, mobile
    protocol.describe("kick")["published"]                # published numbers with units, sources and marks
    result = protocol.run("pull_to_sit", "results/pull", ages=[0, 3, 6], seeds=3, length=0.1)
    for row in result["comparisons"]:
        print(row["published"]["says"], row["ours"], row["difference"])
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any, Optional, Union

from babybench_core import _native

__all__ = ["describe", "names", "run"]


def names() -> list[str]:
    """Returns the names of the protocols of the library."""
    return _native.protocol_names()


def describe(name: str) -> dict[str, Any]:
    """Returns a protocol: phases (s), ages (months), conditions, measures with units, and published numbers with sources.

    Args:
        name: A name, or a document of your own that ends in ``.yml``.

    Raises:
        KeyError: There is no such protocol; the text suggests one.
        OSError: The document cannot be read.
        ValueError: The document has a fault; the text says in which line.
    """
    found: dict[str, Any] = json.loads(_native.protocol_description(name))
    return found


def run(
    name: str,
    out: Union[str, os.PathLike[str]],
    policies: Union[str, Sequence[str]] = "held",
    *,
    ages: Optional[Sequence[float]] = None,
    seeds: int = 1,
    length: float = 1.0,
    jobs: Optional[int] = None,
    keep_records: bool = False,
    policy_timeout: float = 60.0,
    **keys: object,
) -> dict[str, Any]:
    """Runs a protocol into a folder, which gets ``protocol.md``, ``protocol.json``, ``figure.svg`` and ``manifest.json``.

    Finished runs in the folder are not repeated. The same arguments give the same bytes, for any number of jobs.

    Args:
        name: A name, or a document of your own that ends in ``.yml``.
        out: The folder.
        policies: A policy or several, as ``babybench evaluate`` takes them: ``held``, ``color:0.69``, ``zero``, a command, a
            model.
        ages: Ages, months; those of the protocol by default.
        seeds: Number of seeds: 0, 1, ...
        length: Share of the protocol's length, above 0 and at most 1: of its trials if there are several, otherwise of its
            phases.
        jobs: Number of runs at a time; one for each core by default.
        keep_records: Whether ``records`` keeps a record of each run, for :func:`babybench.data.open`.
        policy_timeout: Time limit of a command for an action, s.
        **keys: Other values of keys of the configuration, such as ``strength="volume"``.

    Returns:
        The contents of ``protocol.json``: ``rows`` with means over seeds and intervals of 95 %, ``comparisons`` with
        ``published``, ``ours`` and ``difference``, and ``runs`` with ``values[condition][phase][measure]``.

    Raises:
        KeyError: There is no such protocol; the text suggests one.
        ValueError: A number is outside its range, or a key does not exist.
        RuntimeError: A run failed.
    """
    listed = [policies] if isinstance(policies, str) else list(policies)
    chosen = None if ages is None else [float(age) for age in ages]
    # JSON is YAML
    text = "".join(f"{key}: {json.dumps(value)}\n" for key, value in keys.items())
    found: dict[str, Any] = json.loads(
        _native.run_protocol(name, out, listed, chosen, seeds, length, text, jobs, keep_records, policy_timeout)
    )
    return found
