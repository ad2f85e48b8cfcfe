"""Settings of the estimators by name: what `--set KEY=VALUE` chooses, and what `agora settings` lists."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from pydantic import TypeAdapter, ValidationError

from server.docstrings import field_docstrings
from tracker.errors import InputError
from tracker.estimators import Settings

_ADAPTER = TypeAdapter(Settings)


@dataclass(frozen=True)
class Setting:
    """One setting: its dotted name, its value and what its docstring says."""

    key: str
    value: Any
    meaning: str

    @property
    def text(self) -> str:
        """The value as `--set` would be given it."""
        if isinstance(self.value, tuple):
            return f"[{', '.join(f'{number:.6g}' for number in self.value)}]"
        return self.value if isinstance(self.value, str) else json.dumps(self.value)


def all_settings() -> list[Setting]:
    """Return every setting with its default, in the order of the sources."""
    return list(_settings_of(Settings(), ""))


def changes(settings: Settings) -> dict[str, Any]:
    """Return what differs from the defaults, by key."""
    pairs = zip(_settings_of(settings, ""), all_settings(), strict=True)
    return {own.key: own.value for own, usual in pairs if own.value != usual.value}


def choose(pairs: Iterable[str]) -> Settings:
    """Return settings with some changed: `KEY=VALUE`, where the end of a name that only one setting has is enough.

    Raises:
        InputError: There is no such setting, more than one, or its value is of the wrong kind.
    """
    tree: dict[str, Any] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not equals:
            raise InputError(f"--set {pair!r} has no value: write KEY=VALUE, for instance m_P=literal_enu.")
        *folders, last = _full_key(name.strip()).split(".")
        branch = tree
        for folder in folders:
            branch = branch.setdefault(folder, {})
        branch[last] = _value(text.strip())
    try:
        return _ADAPTER.validate_python(tree)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"] if not isinstance(part, int)) or "a setting"
        raise InputError(f"{where} cannot be {first['input']!r}: {first['msg'].lower()}.") from error


def _full_key(name: str) -> str:
    keys = [setting.key for setting in all_settings()]
    found = [name] if name in keys else [key for key in keys if key.endswith("." + name)]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(f"There is more than one setting {name!r}: {', '.join(found)}.")
    raise InputError(f"There is no setting {name!r}: `agora settings` lists them all.")


def _value(text: str) -> Any:
    """Return numbers, lists and truth values as JSON reads them, anything else as it is written."""
    try:
        return json.loads(text)
    except ValueError:
        return text


def _settings_of(settings: Any, prefix: str) -> Iterator[Setting]:
    meanings = field_docstrings(type(settings))
    for field in fields(settings):
        value = getattr(settings, field.name)
        if is_dataclass(value):
            yield from _settings_of(value, f"{prefix}{field.name}.")
        else:
            yield Setting(prefix + field.name, value, meanings.get(field.name, ""))
