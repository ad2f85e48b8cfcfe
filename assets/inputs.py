"""What a build is made from, as one hash, and the report of the last build, so that nothing is built twice."""

import json
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

import cv2
import numpy as np

from assets.budgets import BuildReport
from assets.packing import PROGRAM, ROOT

CODE = Path(__file__).parent
MEMORY = "report.json"
"""Beside the files of a build; written last, so that it speaks of a whole build."""


def inputs_hash(site_folder: Path, built: Path) -> str:
    """Return the hash of a site's own files, of the code that builds, and of the libraries that paint and pack."""
    total = sha256(f"{np.__version__} {cv2.__version__}".encode())
    for path in [
        *_files(site_folder, built),
        *sorted(CODE.glob("**/*.py")),
        PROGRAM,
        ROOT / "web" / "package-lock.json",
    ]:
        if path.is_file():
            data = path.read_bytes()
            total.update(f"{path.name} {len(data)} ".encode() + data)
    return total.hexdigest()


def _files(folder: Path, built: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.rglob("*")) if path.is_file() and built not in path.parents)


def remembered(built: Path, key: str) -> BuildReport | None:
    """Return the report of the last build, where it was made from the same and all its files are as they were."""
    try:
        memory = json.loads((built / MEMORY).read_bytes())
        report = BuildReport.from_dict(memory["report"])
        if memory["inputs"] != key:
            return None
        whole = all(_hash_of(built / Path(file.path).name) == file.sha256 for file in report.files)
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return report if whole else None


def memory_of(key: str, report: BuildReport) -> bytes:
    """Return what to keep of a build."""
    return json.dumps({"inputs": key, "report": report.as_dict()}, indent=1).encode()


def _hash_of(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()
