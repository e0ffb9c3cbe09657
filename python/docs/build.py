"""Makes a page for each module, and one with the guides: ``python docs/build.py FOLDER``.

Needs pdoc and the installed packages babybench and babybench-kit. Warnings are errors.
"""

from __future__ import annotations

import importlib.util
import sys
import warnings
from pathlib import Path

import pdoc
import pdoc.render
import pdoc.render_helpers

import babybench

HERE = Path(__file__).parent
MODULES = (
    "babybench",
    "babybench.build_xml",
    "babybench.data",
    "babybench.eval",
    "babybench.figures",
    "babybench.mujoco",
    "babybench.protocol",
    "babybench.utils",
    "babybench_core.env",
    "babybench_core.vector",
    "babybench_core.senses",
    "babybench_core.scenes",
    "babybench_core.records",
    "babybench_kit.actuation",
    "babybench_kit.env",
    "babybench_kit.mimo_env",
    "babybench_kit.senses",
    "babybench_kit.sensing",
    "babybench_kit.touch",
    "babybench_kit.tasks.catch",
    "babybench_kit.tasks.dummy",
    "babybench_kit.tasks.muscle_test",
    "babybench_kit.tasks.reach",
    "babybench_kit.tasks.selfbody",
    "babybench_kit.tasks.standup",
    "babybench_kit.utils",
    "babybench_kit.views",
    "babybench_core.mujoco.data",
    "babybench_core.mujoco.model",
)
LINKS = {
    "(docs/from-the-kit.md)": "(#from-the-starter-kit-to-here)",
    "(programs.md)": "(#public-programs-on-mimo)",
    "(from-mimo.md)": "(#from-mimo-to-here)",
    "(docs/mujoco.md)": "(#mujocos-names-without-mujoco)",
    "(../README.md)": "(#babybench-for-python)",
}


def guide() -> str:
    """Returns the README and the guides beside this file as one page of HTML."""
    text = "\n\n".join(
        (HERE / name).read_text("utf-8")
        for name in ("../README.md", "mujoco.md", "from-the-kit.md", "from-mimo.md", "programs.md")
    )
    for link, here in LINKS.items():
        text = text.replace(link, here)
    return str(pdoc.render_helpers.to_html(text))


def main() -> None:
    """Makes the pages."""
    if len(sys.argv) != 2:
        sys.exit("Say where the pages go: python docs/build.py FOLDER")
    modules = list(MODULES)
    if importlib.util.find_spec("stable_baselines3") is not None:
        modules += ["babybench_core.sb3", "babybench_core.sb3_sparse"]
    warnings.simplefilter("error")
    # of what matplotlib uses of pyparsing, where that is newer
    warnings.filterwarnings("ignore", category=DeprecationWarning, module="matplotlib")
    for name in babybench.__all__:
        setattr(babybench, name, getattr(babybench, name))  # pdoc does not see what is imported when it is asked for
    pdoc.render.configure(docformat="google", template_directory=HERE / "template")
    pdoc.render.env.globals["guide"] = guide()
    folder = Path(sys.argv[1])
    pdoc.pdoc(*modules, output_directory=folder)
    made = [folder / (name.replace(".", "/") + ".html") for name in modules]
    missing = [str(page) for page in made if not page.is_file()]
    if missing:
        sys.exit(f"no page was made: {', '.join(missing)}")
    print(f"{len(made)} pages in {folder}")


if __name__ == "__main__":
    main()
