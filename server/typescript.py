"""The page's types of the messages, written from their schema: `make wire` writes `web/src/messages.gen.ts` anew."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import msgspec
from msgspec.inspect import (
    BoolType,
    DictType,
    FloatType,
    IntType,
    ListType,
    LiteralType,
    NoneType,
    StrType,
    StructType,
    TupleType,
    Type,
    UnionType,
    type_info,
)

from server import messages, sockets
from server.docstrings import field_docstrings
from server.session import REPLACED
from server.sessions import ENDED, RESTART
from server.wire import FRAME_HEADER_BYTES, MAX_FRAME_BYTES, POSE_BYTES, SUBPROTOCOL, VERSION

PLACE: Final = Path(__file__).parents[1] / "web" / "src" / "messages.gen.ts"
#: What a page sends may leave out what has a default; what it receives is whole.
SENT: Final = (messages.Ack, messages.ControlRequest, messages.Look)
RECEIVED: Final = (messages.Hello, messages.SessionNews, messages.ControlReply, messages.Company)
CONSTANTS: Final = {
    "VERSION": VERSION,
    "SUBPROTOCOL": SUBPROTOCOL,
    "FRAME_HEADER_BYTES": FRAME_HEADER_BYTES,
    "POSE_BYTES": POSE_BYTES,
    "MAX_FRAME_BYTES": MAX_FRAME_BYTES,
    "FORBIDDEN": sockets.FORBIDDEN,
    "NO_SESSION": sockets.NO_SESSION,
    "OTHER_VERSION": sockets.OTHER_VERSION,
    "REPLACED": REPLACED,
    "ENDED": ENDED,
    "RESTART": RESTART,
}
_LINE: Final = 120


def typescript() -> str:
    """Return the file's text."""
    blocks = ["/** Written by `make wire` from server/messages.py; never edited by hand. */"]
    blocks += [f"export const {name} = {msgspec.json.encode(value).decode()};" for name, value in CONSTANTS.items()]
    text = blocks[0] + "\n\n" + "\n".join(blocks[1:]) + "\n"
    whole = {part for kind in RECEIVED for part in _with_parts(kind)}
    for one in dict.fromkeys(part for kind in (*SENT, *RECEIVED) for part in _with_parts(kind)):
        text += "\n" + _interface(one, whole=one in whole)
    text += f"\nexport type FromViewer = {' | '.join(kind.__name__ for kind in SENT)};\n"
    text += f"\nexport type ToViewer = {' | '.join(kind.__name__ for kind in RECEIVED)};\n"
    return text


def _with_parts(kind: type) -> Iterator[type]:
    """Yield every struct inside a struct, and it last."""
    info = type_info(kind)
    assert isinstance(info, StructType)
    for field in info.fields:
        for part in _structs(field.type):
            yield from _with_parts(part)
    yield kind


def _structs(info: Type) -> Iterator[type]:
    match info:
        case StructType():
            yield info.cls
        case UnionType():
            for one in info.types:
                yield from _structs(one)
        case ListType():
            yield from _structs(info.item_type)
        case DictType():
            yield from _structs(info.value_type)


def _interface(kind: type, *, whole: bool) -> str:
    info = type_info(kind)
    assert isinstance(info, StructType)
    lines = [_comment(kind.__doc__ or "", ""), f"export interface {kind.__name__} {{"]
    if info.tag is not None:
        lines.append(f"  readonly {info.tag_field}: {_literal(info.tag)};")
    meanings = field_docstrings(kind)
    for field in info.fields:
        if field.name in meanings:
            lines.append(_comment(meanings[field.name], "  "))
        mark = "" if field.required or whole else "?"
        lines.append(_broken(f"  readonly {field.encode_name}{mark}: {_type(field.type)};"))
    return "\n".join([*lines, "}"]) + "\n"


def _type(info: Type | Any) -> str:
    match info:
        case StrType():
            return "string"
        case IntType() | FloatType():
            return "number"
        case BoolType():
            return "boolean"
        case NoneType():
            return "null"
        case StructType():
            return info.cls.__name__
        case LiteralType():
            # msgspec sorts them: the order in the source tells nothing, and this one is stable
            return " | ".join(_literal(value) for value in info.values)
        case ListType():
            return f"readonly {_type(info.item_type)}[]"
        case TupleType():
            return f"readonly [{', '.join(map(_type, info.item_types))}]"
        case DictType():
            return f"Readonly<Record<string, {_type(info.value_type)}>>"
        case UnionType():
            return " | ".join(dict.fromkeys(map(_type, info.types)))
    raise TypeError(f"messages may not hold a {type(info).__name__}: the page would not know what it is")


def _literal(value: Any) -> str:
    return msgspec.json.encode(value).decode()


def _comment(text: str, indent: str) -> str:
    return f"{indent}/** {' '.join(text.split())} */"


def _broken(line: str) -> str:
    """Return a field as the page's formatter breaks it: a union that is too long has a line for each member."""
    head, _, kinds = line.partition(": ")
    if len(line) <= _LINE or " | " not in kinds:
        return line
    return f"{head}:\n" + "\n".join(f"    | {kind}" for kind in kinds.split(" | "))


if __name__ == "__main__":
    PLACE.write_text(typescript(), encoding="utf-8")
