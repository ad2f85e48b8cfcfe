"""What the server says of itself while it runs: text for people, or a line of JSON for each event; never a secret."""

import json
import logging
import re
import sys
from datetime import UTC, datetime
from typing import Any, Final, Literal

_STANDARD: Final = frozenset(logging.makeLogRecord({}).__dict__) | {"message", "asctime", "taskName"}
#: Tokens and one-time codes, should one ever come into a message by way of an address or a header.
_SECRET: Final = re.compile(
    r"""(?i)\b((?:token|code|secret|authorization|cookie)["']?\s*[=:]\s*["']?(?:bearer\s+)?|bearer\s+)[^\s"'&,;}]+"""
)

#: uvicorn says this, as an error, of every WebSocket that is refused with a status.
_NO_FAULT: Final = "ASGI callable returned without completing handshake."


class _Events(logging.Formatter):
    """Formats a record without the secrets in it. Fields given by `extra` are the event's own."""

    def fields(self, record: logging.LogRecord) -> dict[str, Any]:
        """Return what `extra` gave."""
        return {name: value for name, value in record.__dict__.items() if name not in _STANDARD}


class TextLines(_Events):
    """`agora: message (session=walk)`."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line; an exception's trace follows it."""
        fields = ", ".join(f"{name}={value}" for name, value in self.fields(record).items())
        text = f"agora: {record.getMessage()}{f' ({fields})' if fields else ''}"
        if record.exc_info:
            text += "\n" + self.formatException(record.exc_info)
        return without_secrets(text)


class JsonLines(_Events):
    """`{"time": …, "level": …, "logger": …, "event": …}` and the event's own fields."""

    def format(self, record: logging.LogRecord) -> str:
        """Return one line of JSON."""
        line: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "event": record.getMessage(),
        }
        line |= {name: value for name, value in self.fields(record).items() if name not in line}
        if record.exc_info:
            line["trace"] = self.formatException(record.exc_info)
        cleaned = {name: without_secrets(value) if isinstance(value, str) else value for name, value in line.items()}
        return json.dumps(cleaned, default=str, ensure_ascii=False)


def without_secrets(text: str) -> str:
    """Return a text in which what follows `token=`, `Bearer` and their like is left out."""
    return _SECRET.sub(r"\1[left out]", text)


def keep_journal(form: Literal["text", "json"], level: str) -> None:
    """Send what is logged from now on to standard error, in one of both forms."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonLines() if form == "json" else TextLines())
    handler.addFilter(lambda record: record.msg != _NO_FAULT)
    logging.basicConfig(level=logging.WARNING, handlers=[handler], force=True)
    logging.getLogger("server").setLevel(level.upper())
