"""What `agora serve` can be told, by file (TOML), by environment and by option: one class is schema, defaults and documentation."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import msgspec
from msgspec import Meta, Struct

from server.limits import Limits
from tracker.errors import InputError

DEFAULT_PLACE: Final = Path("~/.config/agora/server.toml")
_LARGEST_BYTES: Final = 1_000_000
_PREFIX: Final = "AGORA_"
_LIMITS: Final = Limits()


class Configuration(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All of it. A field's description is what `--print-config` says of it."""

    host: Annotated[str, Meta(description="Address to listen on; 0.0.0.0 for every network of this machine.")] = (
        "127.0.0.1"
    )
    port: Annotated[int, Meta(ge=0, le=65535, description="Port to listen on; 0 takes a free one.")] = 8470
    names: Annotated[
        list[str],
        Meta(description="Names by which browsers and rigs may call this server, beside loopback's and `host`."),
    ] = []
    site: Annotated[str, Meta(description="The folder of the site; empty for the State Agora.")] = ""
    web: Annotated[str, Meta(description="The folder of the built pages; empty for this checkout's.")] = ""
    data: Annotated[str, Meta(min_length=1, description="Where uploaded walks are kept, and what is secret.")] = (
        "~/.local/share/agora"
    )
    tls_cert: Annotated[
        str,
        Meta(description="The server's certificate, PEM, with those that lead to the authority's; empty for no TLS."),
    ] = ""
    tls_key: Annotated[str, Meta(description="Its key, PEM.")] = ""
    tls_local: Annotated[
        bool,
        Meta(
            description="TLS by an authority of this server's own, which devices install from a page on the next port."
        ),
    ] = False
    log_format: Annotated[
        Literal["text", "json"], Meta(description="Of what the program says of itself: text, or a line of JSON each.")
    ] = "text"
    log_level: Annotated[
        Literal["debug", "info", "warning", "error"], Meta(description="The least that is worth a line.")
    ] = "info"
    max_sessions: Annotated[int, Meta(ge=1, le=1000, description="Walks at a time, replays among them.")] = 16
    max_viewers: Annotated[int, Meta(ge=1, le=100_000, description="Viewers of one walk.")] = 64
    max_requests_per_s: Annotated[
        float, Meta(gt=0.0, description="Requests, and attempts to connect, of one address in the long run.")
    ] = _LIMITS.requests_per_s
    max_burst: Annotated[float, Meta(ge=1.0, description="So many of them at once.")] = _LIMITS.burst
    max_connections: Annotated[int, Meta(ge=1, description="Connections of one address at a time.")] = (
        _LIMITS.connections
    )
    max_head_s: Annotated[float, Meta(gt=0.0, description="A request's head must have arrived by then.")] = (
        _LIMITS.header_s
    )
    proxies: Annotated[
        list[str],
        Meta(description="Addresses of proxies before this server: it counts whom they name in X-Forwarded-For."),
    ] = msgspec.field(default_factory=lambda: sorted(_LIMITS.proxies))
    max_upload_mb: Annotated[int, Meta(ge=1, description="The largest walk that may be uploaded, 10^6 bytes.")] = 2000
    max_stored_mb: Annotated[int, Meta(ge=1, description="All uploaded walks together, 10^6 bytes.")] = 20_000
    keep_days: Annotated[
        float,
        Meta(ge=0.0, description="Uploaded walks older than this are deleted: they are personal data. 0 for never."),
    ] = 30.0
    max_replays: Annotated[int, Meta(ge=0, le=100, description="Uploaded walks that may be replayed at a time.")] = 4
    replay_idle_s: Annotated[
        float, Meta(gt=0.0, description="A replay that nobody has watched for so long ends by itself.")
    ] = 600.0
    replay_memory_mb: Annotated[
        int, Meta(ge=256, description="Memory of the process that reads an uploaded walk, 10^6 bytes of address space.")
    ] = 4000
    bus: Annotated[
        list[str],
        Meta(description="Servers of NATS, tls://HOST:4222 each, that join this server to others: docs/scale.md."),
    ] = []
    bus_user: Annotated[str, Meta(description="As whom the bus is entered; empty where a certificate says it.")] = ""
    bus_password_file: Annotated[str, Meta(description="A file with that user's password, and nothing else.")] = ""
    bus_ca: Annotated[
        str, Meta(description="Who vouches for the bus's servers, PEM; empty for this machine's authorities.")
    ] = ""
    bus_cert: Annotated[str, Meta(description="This server's certificate for the bus, PEM.")] = ""
    bus_key: Annotated[str, Meta(description="Its key, PEM.")] = ""
    bus_replicas: Annotated[
        int, Meta(ge=1, le=5, description="On how many servers of NATS the sessions' state is kept.")
    ] = 1

    @property
    def limits(self) -> Limits:
        """What one address may ask."""
        return Limits(
            requests_per_s=self.max_requests_per_s,
            burst=self.max_burst,
            connections=self.max_connections,
            header_s=self.max_head_s,
            proxies=frozenset(self.proxies),
        )

    @property
    def hosts(self) -> frozenset[str]:
        """Every name in the Host header that is us."""
        own = {self.host} - {"", "0.0.0.0", "::"}
        return frozenset({"127.0.0.1", "localhost", "::1", *own, *self.names})

    @property
    def data_folder(self) -> Path:
        """`data`, as a path."""
        return Path(self.data).expanduser()

    @property
    def on_loopback(self) -> bool:
        """Whether nobody but this machine can reach the server."""
        return self.host in ("127.0.0.1", "localhost", "::1")


def read_configuration(
    path: Path | None, environment: Mapping[str, str], options: Mapping[str, Any] | None = None
) -> Configuration:
    """Return the configuration: options go before the environment, that before the file, that before the defaults.

    Args:
        path: The file; None for `AGORA_CONFIG`, or the default place if there is a file.
        environment: `AGORA_` and a field's name in capitals; lists are separated by commas.
        options: Fields that the command line gave; None among them says nothing.

    Raises:
        InputError: The file cannot be read, or something in it or in the environment is not what a field takes.
    """
    file = _file_fields(path, environment)
    fields: dict[str, Any] = {}
    for field in msgspec.structs.fields(Configuration):
        name = _PREFIX + field.name.upper()
        text = environment.get(name)
        if text is not None:
            _check(field.name, value := _from_text(field.name, text), f"{name} in the environment")
            fields[field.name] = value
    given = {name: value for name, value in (options or {}).items() if value is not None}
    return _converted(file | fields | given, "the configuration")


def as_toml(configuration: Configuration) -> str:
    """Return a configuration as the text of a file that gives it, every field with what it means."""
    schema = msgspec.json.schema(Configuration)["$defs"]["Configuration"]["properties"]
    lines: list[str] = []
    for name, value in msgspec.structs.asdict(configuration).items():
        lines += [f"# {schema[name]['description']}", f"{name} = {_toml(value)}", ""]
    return "\n".join(lines)


def _file_fields(path: Path | None, environment: Mapping[str, str]) -> dict[str, Any]:
    named = path or (Path(environment["AGORA_CONFIG"]) if environment.get("AGORA_CONFIG") else None)
    place = (named or DEFAULT_PLACE).expanduser()
    if named is None and not place.is_file():
        return {}
    try:
        with place.open("rb") as file:
            data = file.read(_LARGEST_BYTES + 1)
        if len(data) > _LARGEST_BYTES:
            raise InputError(f"{place} is too large to be a configuration: start from `agora serve --print-config`.")
        fields = tomllib.loads(data.decode())
    except OSError as exc:
        raise InputError(f"{place} cannot be read: {exc.strerror}; `agora serve --print-config` prints one.") from exc
    except (ValueError, RecursionError) as exc:
        raise InputError(f"{place} is no TOML ({exc}): start from `agora serve --print-config`.") from exc
    _converted(fields, str(place))
    return fields


def _from_text(name: str, text: str) -> Any:
    default = getattr(Configuration(), name)
    if isinstance(default, bool):
        return {"true": True, "false": False}.get(text, text)
    if isinstance(default, list):
        return [part.strip() for part in text.split(",") if part.strip()]
    if isinstance(default, int | float):
        try:
            return type(default)(text)
        except ValueError:
            return text  # the check says what was expected
    return text


def _check(name: str, value: Any, where: str) -> None:
    try:
        msgspec.convert({name: value}, Configuration)
    except msgspec.ValidationError as exc:
        raise InputError(f"{where}: {exc}; `agora serve --print-config` lists what there is.") from exc


def _converted(fields: Mapping[str, Any], where: str) -> Configuration:
    try:
        return msgspec.convert(fields, Configuration)
    except msgspec.ValidationError as exc:
        raise InputError(f"{where}: {exc}; `agora serve --print-config` lists what there is.") from exc


def _toml(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    # JSON's strings and numbers are TOML's, but for DEL
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
