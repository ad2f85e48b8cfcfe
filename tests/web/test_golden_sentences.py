"""`tests/golden/sentences.json`: what servers and rigs tell visitors, out of the programs' own text. `told.test.ts` reads it, too.

Run as a program, this file writes it anew.
"""

import ast
import json
from collections.abc import Iterator
from pathlib import Path

from tracker.running.health import KINDS, Watch
from tracker.sources.source import SourceStatus

ROOT = Path(__file__).parents[2]
GOLDEN_PATH = ROOT / "tests" / "golden" / "sentences.json"
TELLING = (
    "server/replay.py",
    "server/live_rig.py",
    "server/session.py",
    "server/sessions.py",
    "server/push.py",
    "server/aligning.py",
    "tracker/said.py",
    "tracker/retractable.py",
)
NAMED = ("UNCALIBRATED", "_AWAITED", "_LEFT", "_misfit")
"""Constants and attributes that are told."""
SECOND_NS = 1_000_000_000


def golden() -> dict[str, list[str]]:
    """Return what the file must hold."""
    return {"sentences": sorted({*_written(), *_of_sensors()})}


def _written() -> Iterator[str]:
    """Yield what stands in the programs: notices, errors of replies, and what an alignment is refused for."""
    for path in TELLING:
        for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
            match node:
                case ast.FunctionDef(name="_notice" | "refusal_words"):
                    yield from (
                        text for part in ast.walk(node) if isinstance(part, ast.Return) for text in _text(part.value)
                    )
                case ast.Assign(targets=[ast.Name(id="notice")], value=ast.IfExp(body=said)):
                    yield from _text(said)
                case ast.keyword(arg="error"):
                    yield from _text(node.value)
                case ast.Raise(exc=ast.Call(func=ast.Name(id="InputError"), args=[said])):
                    yield from _text(said)
                case ast.Assign(targets=[ast.Name(id=name) | ast.Attribute(attr=name)]) if name in NAMED:
                    yield from _text(node.value)
                case ast.AnnAssign(target=ast.Name(id=name)) if name in NAMED:
                    yield from _text(node.value)


def _text(node: ast.expr | None) -> Iterator[str]:
    """Yield the sentence that an expression is, 7 in the place of each value."""
    match node:
        case ast.Constant(value=str(text)):
            yield text
        case ast.JoinedStr(values=parts):
            yield "".join(str(part.value) if isinstance(part, ast.Constant) else "7" for part in parts)


def _of_sensors() -> Iterator[str]:
    """Yield how sensors are told of in every trouble that they can have."""
    late_ns = 60 * SECOND_NS
    for name in KINDS:
        for arrived in (False, True):
            for trouble in ("silent", "stuck", "unusable", "lost", "failed", "unplugged"):
                watch = Watch(name, 0)
                now_ns = late_ns if trouble in ("silent", "unplugged") else SECOND_NS // 10
                if arrived:
                    watch.arrived(SECOND_NS // 20)
                if trouble == "lost":
                    watch.lost("the cable was pulled.")
                if trouble == "failed":
                    watch.failed("there is no driver.")
                watch.is_stuck, watch.is_unusable = trouble == "stuck", trouble == "unusable"
                status = (
                    SourceStatus(attached=False, detail="nothing is plugged in") if trouble == "unplugged" else None
                )
                health = watch.read(now_ns, status)
                if health.state.is_trouble:
                    yield health.sentence


def test_the_golden_file_is_what_this_says() -> None:
    assert json.loads(GOLDEN_PATH.read_text(encoding="utf-8")) == golden()


def test_sentences_of_every_kind_are_found() -> None:
    sentences = golden()["sentences"]
    assert len(sentences) > 25
    for part in (
        "is gone",
        "The rig has not come yet.",
        "breaks off after 7 s",
        "too long ago",
        "The replay has ended.",
    ):
        assert any(part in sentence for sentence in sentences), part


if __name__ == "__main__":
    GOLDEN_PATH.write_text(json.dumps(golden(), indent=1) + "\n", encoding="utf-8")
