"""Records in the formats of other programs: each by a library of its own, behind an extra of this package.

``python -m babybench export RECORD --to parquet,nwb --out DIR`` and the methods of
:class:`babybench.data.Record` (``record.to_parquet(...)``) call this module.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from babybench_core.data import Record


@dataclass(frozen=True)
class Format:
    """A format and the function that writes it."""

    extra: str
    """The extra of this package that installs what it needs; the module of this package that writes it has the same name."""
    library: str
    """The module that it needs."""
    file: str
    """Name that :func:`export` gives the file or folder in the folder of the export."""
    what: str
    """Description, one line."""


FORMATS: dict[str, Format] = {
    "parquet": Format("parquet", "pyarrow", "record.parquet", "a table of steps, with touch and contacts as lists"),
    "hdf5": Format("hdf5", "h5py", "record.h5", "every array of the record with its unit, a group for each episode"),
    "nwb": Format("nwb", "pynwb", "record.nwb", "Neurodata Without Borders: time series, episodes as trials"),
    "rerun": Format("rerun", "rerun", "record.rrd", "3D, eyes, touch and scalars over time, for the viewer of Rerun"),
    "tensorboard": Format("tensorboard", "tensorboard", "tensorboard", "scalars of steps and of episodes"),
    "minari": Format("minari", "minari", "minari", "a data set for offline learning, of observations and actions"),
}
"""The formats by name."""


def library(format: str) -> Any:
    """Imports the library of a format.

    Raises:
        ModuleNotFoundError: It is not installed; the error says how to install it.
    """
    wanted = FORMATS[format]
    try:
        return importlib.import_module(wanted.library)
    except ModuleNotFoundError as error:
        if error.name != wanted.library:
            raise
        raise ModuleNotFoundError(
            f"{format} needs the module {wanted.library}, which is not installed: pip install 'babybench[{wanted.extra}]'",
            name=wanted.library,
        ) from None


def check(formats: list[str]) -> None:
    """Checks that formats exist and that their libraries are installed, before anything is written.

    Raises:
        ValueError: The format does not exist.
        ModuleNotFoundError: A library is not installed.
    """
    for name in formats:
        if name not in FORMATS:
            raise ValueError(f"there is no format {name!r}; there are {', '.join(FORMATS)}")
        library(name)


def export(record: Record, formats: list[str], out: Path) -> dict[str, Path]:
    """Writes a record in several formats into a folder; returns the path of each.

    Raises:
        ValueError: The format does not exist, or the record has no episodes.
        ModuleNotFoundError: A library is not installed; nothing is written then.
        FileExistsError: A file that would be written already exists; then nothing is written.
    """
    check(formats)
    paths = {name: out / FORMATS[name].file for name in formats}
    for path in paths.values():
        if path.exists():
            raise FileExistsError(f"{path} already exists; name another folder, or remove it")
    out.mkdir(parents=True, exist_ok=True)
    for name, path in paths.items():
        if name == "minari":
            record.to_minari(path=path)
        else:
            getattr(record, f"to_{name}")(path)
    return paths


def episodes(record: Record) -> list[int]:
    """Returns the numbers of a record's episodes.

    Raises:
        ValueError: There are none.
    """
    numbers = list(record)
    if not numbers:
        raise ValueError(f"{record.folder}: the record has no episodes; record some steps first")
    return numbers
