"""The systemd units: what they run exists, and systemd reads them."""

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli import app

UNITS = sorted((Path(__file__).parents[2] / "server" / "systemd").glob("*.service"))


def command_of(unit: Path) -> list[str]:
    (line,) = re.findall(r"^ExecStart=(.*)$", unit.read_text(encoding="utf-8"), re.MULTILINE)
    return shlex.split(line)


def test_there_is_one_for_the_rig_and_one_for_the_server() -> None:
    assert [unit.stem for unit in UNITS] == ["agora-rig", "agora-server"]


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.stem)
def test_a_units_command_and_its_options_are_agoras(unit: Path) -> None:
    program, command, *arguments = command_of(unit)
    assert program.endswith("/.venv/bin/agora")
    shown = CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb"})
    assert shown.exit_code == 0
    for option in (argument for argument in arguments if argument.startswith("--")):
        assert re.search(rf"{option}\b", shown.stdout), f"{command} has no {option}"


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.stem)
def test_no_secret_stands_on_a_command_line(unit: Path) -> None:
    assert "token" not in " ".join(command_of(unit)).lower()


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.stem)
def test_systemd_reads_the_unit(unit: Path, tmp_path: Path) -> None:
    verify = shutil.which("systemd-analyze")
    if verify is None:
        pytest.skip("no systemd-analyze")
    agora = tmp_path / "agora"
    agora.write_text("#!/bin/sh\n")
    agora.chmod(0o755)
    text = unit.read_text(encoding="utf-8").replace("/opt/agora/.venv/bin/agora", str(agora))
    (tmp_path / unit.name).write_text(text, encoding="utf-8")
    done = subprocess.run(
        [verify, "verify", str(tmp_path / unit.name)], capture_output=True, text=True, timeout=60, check=False
    )
    said = [line for line in done.stderr.splitlines() if unit.name in line]
    assert (done.returncode, said) == (0, []), done.stderr
