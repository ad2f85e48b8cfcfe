"""docs/protocol.md is enough for a stranger: its examples run against a real server, and its tables are those of the code."""

import json
import re
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import get_args

import pytest

from server import wire
from server.access import Access
from server.grants import ABILITIES
from server.messages import Action
from server.typescript import CONSTANTS
from tests.server.serving import serving, text_of, token, until, viewer

GUIDE = (Path(__file__).parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")
WATCH, PUSH = re.findall(r"^```python\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)
BYTES = {"u8": 1, "u16": 2, "u32": 4, "i64": 8, "f32": 4, "f64": 8, "bytes": 1}


@contextmanager
def running(folder: Path, source: str, *arguments: str) -> Iterator["subprocess.Popen[str]"]:
    program = folder / f"{source[3:7]}.py"
    program.write_text(source, encoding="utf-8")
    # far from the repository: a stranger has none of it
    command = [sys.executable, "-P", str(program), *arguments]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def test_the_examples_work_with_each_other_over_a_real_server(tmp_path: Path) -> None:
    (tmp_path / "picture.jpg").write_bytes(b"\xff\xd8\xff\xd9")
    access = Access.with_secret(bytes(32))
    with serving(tmp_path, access=access) as server:
        url = server.rig_url("walk")
        with running(tmp_path, PUSH, url, token("rig", "walk"), str(tmp_path / "picture.jpg")):
            until(lambda: any(session.frames for session in server.app.state.sessions))
            with running(tmp_path, WATCH, url.replace("/rig/", "/view/"), token("viewer", "walk")) as watching:
                assert watching.stdout is not None
                assert watching.stdout.readline() == "watching walk as viewer\n"
                assert watching.stdout.readline() == "frame 7: 2.00 m east, 3.00 m north, 1.70 m up\n"
            shown = {"Authorization": f"Bearer {token('operator')}"}
            with viewer(server, additional_headers=shown) as asking:
                asking.send(json.dumps({"type": "control", "request_id": "1", "action": "pause"}))
                assert text_of(asking, "reply")["error"] == "I cannot."


def rows(heading: str) -> list[tuple[int, str]]:
    section = GUIDE.partition(f"## {heading}")[2].partition("\n## ")[0]
    return [(int(offset), kind) for offset, kind in re.findall(r"^\| (\d+) \| ([^|]+) \|", section, re.MULTILINE)]


def size_of(kind: str) -> int:
    parts = [part.split() for part in kind.split(", ")]
    return sum(int(part[0]) * BYTES[part[1]] if len(part) == 2 else BYTES[part[0]] for part in parts)


@pytest.mark.parametrize(
    ("heading", "layout", "size"),
    [
        ("Frame message: `AGF1`", wire._FRAME, wire.FRAME_HEADER_BYTES),
        ("Pose message: `AGP1`", wire._POSE, wire.POSE_BYTES),
    ],
)
def test_the_tables_leave_no_byte_unsaid(heading: str, layout: struct.Struct, size: int) -> None:
    table = rows(heading)
    assert layout.size == size
    assert table[0][0] == 0
    for (offset, kind), (following, _) in pairwise([*table, (size, "")]):
        assert offset + size_of(kind) == following, f"the row at {offset}"


def test_every_code_role_and_action_is_explained() -> None:
    codes = {str(value) for name, value in CONSTANTS.items() if isinstance(value, int) and 1000 < value < 5000}
    assert codes <= set(re.findall(r"\d{4}", GUIDE))
    assert {f"`{role}`" for role in ABILITIES if role != "local"} <= set(re.findall(r"`\w+`", GUIDE))
    assert {f"`{action}`" for action in get_args(Action)} <= set(re.findall(r"`\w+`", GUIDE))
