"""The methods of a record that write it for other programs."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union, cast

if TYPE_CHECKING:
    from babybench_core.data import Record


class Exports:
    """Exports of :class:`babybench.data.Record`, with libraries that are imported on first use."""

    @property
    def _record(self) -> Record:
        return cast("Record", self)

    def to_parquet(self, path: Union[str, Path]) -> None:
        """Writes a Parquet file (``pip install 'babybench[parquet]'``): a row for each step of every episode.

        Angles, velocities, actions, rewards and touch by region are columns; touch and contacts are columns of lists. The
        metadata of a column has its ``unit`` and ``meaning``, that of the table the manifest (``babybench``, JSON).

        Raises:
            ModuleNotFoundError: pyarrow is not installed.
            ValueError: The record has no episodes.
        """
        from babybench_core.export import parquet

        parquet.write(self._record, Path(path))

    def to_hdf5(self, path: Union[str, Path]) -> None:
        """Writes an HDF5 file (``pip install 'babybench[hdf5]'``): every array of the record.

        Groups are ``episode_N``, ``skin`` and ``names``; each array has the attributes ``unit`` and ``meaning``, the file
        has ``manifest`` (JSON).

        Raises:
            ModuleNotFoundError: h5py is not installed.
            ValueError: The record has no episodes.
        """
        from babybench_core.export import hdf5

        hdf5.write(self._record, Path(path))

    def to_nwb(self, path: Union[str, Path], session_start_time: Optional[datetime.datetime] = None) -> None:
        """Writes a file of Neurodata Without Borders (``pip install 'babybench[nwb]'``).

        The record is a session, its episodes are trials with a second between them; angles, velocities, actions, rewards
        and touch by region are time series, the skin is a table with lists, recorded eyes are image series.

        Args:
            path: The file, ``.nwb``.
            session_start_time: When it began, with a time zone; by default when the manifest was last written.

        Raises:
            ModuleNotFoundError: pynwb is not installed.
            ValueError: The record has no episodes.
        """
        from babybench_core.export import nwb

        nwb.write(self._record, Path(path), session_start_time)

    def to_rerun(self, path: Union[str, Path], *, every: int = 1, eyes_every: int = 10) -> None:
        """Writes a recording for the viewer of Rerun (``pip install 'babybench[rerun]'``): ``rerun record.rrd`` shows it.

        MIMo and the scene move in 3D. Sensors that feel something are points on the skin, coloured by force. Eyes are images;
        angles, touch by region and rewards are curves over simulated time. Each episode has its own path.

        Args:
            path: The file, ``.rrd``.
            every: Number of steps from one pose to the next.
            eyes_every: Number of steps from one pair of images to the next where the record has none: these are redrawn from
                the recorded positions, as sharp as the resolution allows; 0 for none. Recorded images are used as they are.

        Raises:
            ModuleNotFoundError: rerun-sdk is not installed.
            ValueError: The record has no episodes, or a number of steps is not positive.
        """
        from babybench_core.export import rerun

        rerun.write(self._record, Path(path), every, eyes_every)

    def to_tensorboard(self, path: Union[str, Path], *, every: int = 1) -> None:
        """Writes a folder for TensorBoard (``pip install 'babybench[tensorboard]'``): scalars by step, measures by episode.

        Args:
            path: The folder.
            every: Number of steps from one point to the next.

        Raises:
            ModuleNotFoundError: tensorboard is not installed.
            ValueError: The record has no episodes, or ``every`` is not positive.
        """
        from babybench_core.export import tensorboard

        tensorboard.write(self._record, Path(path), every)

    def to_minari(self, dataset_id: str = "babybench/record-v0", path: Optional[Union[str, Path]] = None) -> Any:
        """Makes a data set of Minari (``pip install 'babybench[minari]'``) for offline learning, and returns it.

        It has all observations of the environment: those that were not recorded are computed again, with the same bits.

        Args:
            dataset_id: Its name: ``namespace/name-vN``.
            path: The folder of data sets; by default Minari's (``MINARI_DATASETS_PATH``).

        Raises:
            ModuleNotFoundError: minari is not installed.
            ValueError: The record has no episodes, an episode cannot be repeated, or the data set exists.
        """
        from babybench_core.export import minari

        return minari.write(self._record, dataset_id, None if path is None else Path(path))
