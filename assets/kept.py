"""Arrays kept in a file: made once, read ever after, by several processes at a time."""

import os
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np
from numpy.typing import NDArray


def kept_arrays(path: Path, make: Callable[[], Mapping[str, NDArray[np.generic]]]) -> dict[str, NDArray[np.generic]]:
    """Return the arrays of a file by name; where it is missing or broken, make them and write it.

    The file appears whole: two that make it at once write the same, and the later one stays.
    """
    try:
        # numpy leaves a file open that it opened and found broken
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            return {name: held[name] for name in held.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        pass  # missing, or a machine stopped while it was copied: it is made again
    made = dict(make())
    path.parent.mkdir(parents=True, exist_ok=True)
    with NamedTemporaryFile(dir=path.parent, prefix=path.stem, suffix=".part", delete=False) as part:
        np.savez(part, **made)  # type: ignore[arg-type]  # numpy's stub takes allow_pickle for one of the names
    os.replace(part.name, path)
    return made
