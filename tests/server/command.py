"""`agora` without a process of its own, which takes a second to start."""

import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from server.cli import main


def agora_here(*arguments: str | Path) -> "CompletedProcess[str]":
    """Run a command in this process and return what it said, and the code that it ended with."""
    command = ["agora", *map(str, arguments)]
    out, err = StringIO(), StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.setattr(sys, "argv", command)
        with pytest.raises(SystemExit) as ended:
            main()
    code = ended.value.code
    assert isinstance(code, int)
    return CompletedProcess(command, code, out.getvalue(), err.getvalue())
