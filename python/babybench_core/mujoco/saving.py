"""``mj_saveLastXML``: the document of a model as a file."""

from __future__ import annotations

import os

from .. import _native
from .model import MjModel, is_compiled

__all__ = ["mj_saveLastXML"]


def mj_saveLastXML(filename: str | os.PathLike[str], m: MjModel) -> None:
    """Writes the document that a model was compiled from, as one file without ``<include>``.

    Unlike MuJoCo's, it does not include values written into the model's arrays since.

    Raises:
        ValueError: The document is not known, or cannot be written as one file.
        NotImplementedError: Numbers were written into the model since it was compiled.
    """
    from .spec import MjSpec

    if not is_compiled(m):
        raise TypeError(f"expected an MjModel of babybench.mujoco, not {type(m).__module__}.{type(m).__name__}")
    source = m._source
    if source is None:
        raise ValueError("the document of this model is not UTF-8 text")
    fresh = MjModel._made(source.compile(), source)
    changed = [name for name, array in m._arrays.items() if array.tobytes() != fresh._arrays[name].tobytes()]
    if changed or m.opt._differs(fresh.opt):
        raise NotImplementedError(
            f"mj_saveLastXML: {', '.join(changed) or 'opt'} was written into the model, and is not in its document: edit that "
            "with MjSpec, and write it with to_xml"
        )
    path = os.path.join(source.folder, "model.xml")
    own = _native.MjcfDocument.from_text(source.text, path, dict(source.files), "")
    text = MjSpec._made(own, source.files, source.folder).to_xml()
    with open(filename, "w", encoding="utf-8") as file:
        file.write(text)
