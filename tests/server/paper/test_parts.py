"""Every part of the paper has its place in the code, and that place says so; the walk itself is tested on places that do not."""

import ast
import re
from pathlib import Path

import pytest

from server.paper.parts import PARTS, Part

ROOT = Path(__file__).parents[3]


def find(tree: ast.Module, symbol: str) -> tuple[ast.stmt, str] | None:
    """Return the statement that defines `symbol` (dots lead into classes), and what the source says of it; None where none does."""
    body: list[ast.stmt] = tree.body
    found: ast.stmt | None = None
    for name in symbol.split("."):
        found = next((node for node in body if name in names(node)), None)
        if found is None:
            return None
        body = found.body if isinstance(found, ast.ClassDef) else []
    if isinstance(found, ast.FunctionDef | ast.ClassDef):
        return found, ast.get_docstring(found) or ""
    return (found, "") if found else None


def names(node: ast.stmt) -> list[str]:
    match node:
        case ast.FunctionDef() | ast.ClassDef():
            return [node.name]
        case ast.Assign():
            return [target.id for target in node.targets if isinstance(target, ast.Name)]
        case ast.AnnAssign(target=ast.Name(id=name)):
            return [name]
        case _:
            return []


def comment_above(source: str, node: ast.stmt) -> str:
    """Return the `#:` lines right above a constant."""
    lines, found = source.splitlines(), []
    for line in reversed(lines[: node.lineno - 1]):
        if not line.startswith("#:"):
            break
        found.append(line[2:])
    return " ".join(reversed(found))


def missing(part: Part, root: Path = ROOT) -> list[str]:
    """Return in words what of a part points nowhere."""
    file, _, symbol = part.where.partition(":")
    if not (root / file).is_file():
        return [f"no file {file}"]
    source = (root / file).read_text(encoding="utf-8")
    tree = ast.parse(source)
    said, wrong = ast.get_docstring(tree) or "", []
    if symbol:
        found = find(tree, symbol)
        if found is None:
            return [f"no {symbol} in {file}"]
        node, own = found
        own = own or comment_above(source, node)
        said = own if part.cites.startswith("eq") else f"{own} {said}"
    if not re.search(re.escape(part.cites) + r"(?!\d)", " ".join(said.split()), re.IGNORECASE):
        wrong.append(f"{part.where} does not say {part.cites!r}")
    test_file, _, test = part.test.partition("::")
    if not (root / test_file).is_file():
        wrong.append(f"no file {test_file}")
    elif not test.startswith("test_") or find(ast.parse((root / test_file).read_text(encoding="utf-8")), test) is None:
        wrong.append(f"no {test} in {test_file}")
    return wrong


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.name)
def test_a_part_is_where_it_is_said_to_be(part: Part) -> None:
    assert missing(part) == []


def test_all_twelve_equations_are_there() -> None:
    """Each number once at least, in a citation, and none that the paper has not."""
    cited = {int(number) for part in PARTS if part.cites.startswith("eq") for number in re.findall(r"\d+", part.cites)}
    assert cited == set(range(1, 13))


def test_names_are_unique_and_places_are_different() -> None:
    assert len({part.name for part in PARTS}) == len(PARTS)
    assert len({(part.where, part.cites) for part in PARTS}) == len(PARTS)


SOURCE = '''"""Of eq. 3."""
#: A constant of
#: eq. 4.
C = 4
class A:
    """Eq. 5."""
    def b(self) -> int:
        """Eq. 15."""
        return 0
'''


@pytest.mark.parametrize(
    ("where", "cites", "test", "wrong"),
    [
        ("a.py", "eq. 3", "test_a.py::test_one", []),
        ("a.py:C", "eq. 4", "test_a.py::test_one", []),
        ("a.py:C", "eq. 3", "test_a.py::test_one", ["a.py:C does not say 'eq. 3'"]),
        ("a.py:A", "eq. 5", "test_a.py::test_one", []),
        ("a.py:A.b", "eq. 15", "test_a.py::test_one", []),
        ("a.py:A.b", "eq. 1", "test_a.py::test_one", ["a.py:A.b does not say 'eq. 1'"]),
        ("a.py:A.c", "eq. 5", "test_a.py::test_one", ["no A.c in a.py"]),
        ("b.py:A", "eq. 5", "test_a.py::test_one", ["no file b.py"]),
        ("a.py:A", "eq. 5", "test_a.py::test_two", ["no test_two in test_a.py"]),
        ("a.py:A", "eq. 5", "test_a.py::helper", ["no helper in test_a.py"]),
        ("a.py:A", "eq. 5", "test_b.py::test_one", ["no file test_b.py"]),
    ],
)
def test_what_points_nowhere_is_found(tmp_path: Path, where: str, cites: str, test: str, wrong: list[str]) -> None:
    (tmp_path / "a.py").write_text(SOURCE, encoding="utf-8")
    (tmp_path / "test_a.py").write_text("def test_one() -> None:\n    pass\ndef helper() -> None:\n    pass\n")
    assert missing(Part("a part", where, cites, test), tmp_path) == wrong
