"""What the repository promises as a whole: no download address, every package pinned by hash, commands that exist."""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]
LOCKS = ("requirements.lock", "requirements-dev.lock", "requirements-tools.lock")
HOSTS = ("pypi" + ".org", "pythonhosted" + ".org", "npmjs" + ".org", "npmjs" + ".com", "yarnpkg" + ".com")
DOWNLOAD = re.compile(
    "|".join(
        (
            *(re.escape(host) for host in HOSTS),
            r"https?://[^\s\"'<>)]*(?:/simple\b|\.whl\b|\.tgz\b|\.tar\.[gx]z\b|artifactory|/-/)",
            r"^\s*(?:--)?(?:extra-|default-)?index(?:-url)?\s*[=\s]\s*\"?https?:",
            r"^\s*registry\s*=",
        )
    ),
    re.IGNORECASE | re.MULTILINE,
)
COMMAND = re.compile(r"(?<![\w`/-])make ([a-z]+)\b")


def repository_files() -> list[Path]:
    """Return every file that is or would be committed."""
    listing = ("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard")
    names = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    return [path for name in names if name and (path := ROOT / name).is_file()]


def shell_lines(markdown: str) -> list[str]:
    """Return the lines of `markdown` that stand in a code block, fenced or indented."""
    fenced = re.findall(r"^```[^\n]*\n(.*?)^```", markdown, re.MULTILINE | re.DOTALL)
    indented = re.findall(r"^(?: {4}|\t)(.+)$", markdown, re.MULTILINE)
    return [line.strip() for block in fenced for line in block.splitlines()] + indented


def targets() -> set[str]:
    return set(re.findall(r"^([a-z]+):(?!=)", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))


def test_no_file_holds_a_download_address() -> None:
    found = {}
    for path in repository_files():
        text = path.read_bytes()
        if b"\0" not in text and (match := DOWNLOAD.search(text.decode("utf-8", errors="replace"))):
            found[path.relative_to(ROOT).as_posix()] = match.group()
    found.pop("tests/test_repository.py", None)
    assert not found


@pytest.mark.parametrize("line", ["registry=x", "--index-url https://a.example/", "see https://a.example/b/-/b-1.tgz"])
def test_a_download_address_is_recognised(line: str) -> None:
    assert DOWNLOAD.search(line)


@pytest.mark.parametrize("name", LOCKS)
def test_every_python_package_is_pinned_by_hash(name: str) -> None:
    blocks = re.split(r"\n(?=[A-Za-z0-9])", (ROOT / name).read_text(encoding="utf-8"))
    packages = [block for block in blocks if not block.startswith("#")]
    loose = [block.splitlines()[0] for block in packages if "==" not in block or "--hash=sha256:" not in block]
    assert packages
    assert not loose


def is_for_debian(package: dict[str, Any]) -> bool:
    """Return whether Debian or Ubuntu could ever install `package` of package-lock.json: it is for Linux, with the GNU libc."""
    return "linux" in package.get("os", ["linux"]) and "glibc" in package.get("libc", ["glibc"])


def test_every_web_package_is_pinned_by_hash_and_has_no_address() -> None:
    packages = json.loads((ROOT / "web/package-lock.json").read_text(encoding="utf-8"))["packages"]
    locked = {name: package for name, package in packages.items() if name}
    assert locked
    assert not [name for name, package in locked.items() if "resolved" in package]
    assert not [name for name, package in locked.items() if "integrity" not in package and is_for_debian(package)]


def test_what_the_project_asks_for_is_locked() -> None:
    for lock, marker in (
        ("requirements.lock", "agora (pyproject.toml)"),
        ("requirements-dev.lock", "agora (pyproject.toml:dev)"),
    ):
        assert marker in (ROOT / lock).read_text(encoding="utf-8")


def test_the_readme_names_only_targets_that_exist() -> None:
    named = {
        name for line in shell_lines((ROOT / "README.md").read_text(encoding="utf-8")) for name in COMMAND.findall(line)
    }
    assert "test" in named
    assert named <= targets()


def test_ci_runs_the_test_command_of_the_readme() -> None:
    assert (ROOT / ".ci/run").read_text(encoding="utf-8").splitlines()[-1] == "exec make test"
    assert (ROOT / ".ci/run").stat().st_mode & 0o111
