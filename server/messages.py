"""The text messages of both sockets: JSON, checked against these classes. Pure.

Viewer -> server: `ack`, `control`, `look`. Server -> rig: `control`. Rig -> server: `state`, `reply`, `figures`. Server -> viewer:
`hello`, `state`, `reply`, `company`, and `figures` where they were asked for. What a class does not name is ignored, so an older
server understands a newer rig.
"""

from typing import Annotated, Any, Final, Literal, TypeAlias, TypeVar

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from server.errors import MalformedMessage
from server.grants import Role
from server.wire import VERSION

MAX_VIEWER_TEXT: Final = 4 * 1024
MAX_RIG_TEXT: Final = 64 * 1024

T = TypeVar("T")
Action = Literal["play", "pause", "seek", "speed", "loop", "estimator", "align", "share", "settings", "figures"]
Seconds: TypeAlias = Annotated[float, Meta(ge=0.0, le=1e9)]
Offset: TypeAlias = Annotated[float, Meta(ge=-1e11, le=1e11)]
Name: TypeAlias = Annotated[str, Meta(max_length=256)]
Sentence: TypeAlias = Annotated[str, Meta(max_length=2000)]
Metres: TypeAlias = Annotated[float, Meta(ge=-1e5, le=1e5)]
Pixel: TypeAlias = Annotated[float, Meta(ge=-1.0, le=16384.0)]
FrameId: TypeAlias = Annotated[int, Meta(ge=0, lt=2**32)]


class Ack(Struct, frozen=True, tag_field="type", tag="ack"):
    """A viewer has drawn, or dropped, this frame."""

    frame_id: FrameId


class Eye(Struct, frozen=True):
    """Where somebody stands in the virtual square, and where they look."""

    place_site_m: tuple[Metres, Metres, Metres]
    heading_rad: Annotated[float, Meta(ge=-7.0, le=7.0)]
    """Clockwise from north."""
    pitch_rad: Annotated[float, Meta(ge=-1.6, le=1.6)]
    """Upwards from the level."""


class Look(Struct, frozen=True, tag_field="type", tag="look"):
    """A viewer shows the others where it looks from: at most ten times a second, and again within ten seconds."""

    eye: Eye | None
    """Null for: no longer."""


class Companion(Struct, frozen=True, forbid_unknown_fields=True):
    """One of those who watch, and has said from where."""

    number: int
    """As in its own `hello`."""
    eye: Eye


class Company(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="company"):
    """Who watches: the whole of it anew, at most four times a second. Nothing here tells who they are."""

    watching: int
    """How many there are, the reader among them."""
    seen: list[Companion]
    """Those who have said where they look from, at most 32, the reader among them."""


class Tap(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="tap"):
    """A visitor has pointed at a landmark in a picture."""

    frame_id: FrameId
    place_px: tuple[Pixel, Pixel]
    """Of the picture as stored; (0, 0) is the centre of its first pixel."""
    sigma_px: Annotated[float, Meta(ge=0.1, le=500.0)]
    point_site_m: tuple[Metres, Metres, Metres]


class Here(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="here"):
    """A visitor has shown on the plan where the rig is."""

    e_m: Metres
    n_m: Metres
    sigma_m: Annotated[float, Meta(ge=0.01, le=100.0)]


class TakeBack(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="undo"):
    """A visitor takes the last tap or place back."""


Alignment: TypeAlias = Tap | Here | TakeBack


class ControlRequest(Struct, frozen=True, tag_field="type", tag="control"):
    """A viewer asks the rig for something."""

    request_id: Annotated[str, Meta(min_length=1, max_length=64)]
    action: Action
    value: bool | float | Name | Alignment | None = None
    """Seconds for `seek`, a factor for `speed`, a name for `estimator`, an alignment for `align`, whether to for `loop` and for
    `share`, `KEY=VALUE` for `settings`, and an empty text for the usual ones again."""


class ControlReply(Struct, frozen=True, tag_field="type", tag="reply"):
    """What became of a request."""

    request_id: Name
    ok: bool
    error: Sentence | None = None
    did_seek: bool = False


class Playback(Struct, frozen=True):
    """Where a replay stands."""

    playing: bool
    position_s: Seconds
    speed: Annotated[float, Meta(gt=0.0, le=1e3)]
    looping: bool


class SensorHealth(Struct, frozen=True):
    """How one sensor of a live rig is."""

    trouble: bool
    """Whether somebody should do something."""
    sentence: Sentence
    """What is the matter and what to do; or that all is well."""
    state: Name = ""
    rate_hz: Annotated[float, Meta(ge=0.0, le=1e6)] = 0.0


class Update(Struct, frozen=True):
    """What one update of a filter saw: measured less predicted."""

    t_s: Annotated[float, Meta(ge=-1e9, le=1e9)]
    """As the frames' `position_s`."""
    position_m: Annotated[float, Meta(ge=0.0, le=1e9)]
    """Length of the difference."""
    rotation_rad: Annotated[float, Meta(ge=0.0, le=10.0)]
    motion_model: Name


class Figures(Struct, frozen=True, tag_field="type", tag="figures"):
    """What an operator wants to see of the tracker at work, about once a second."""

    anew: bool
    """Whether what was told before is to be forgotten."""
    updates: Annotated[list[Update], Meta(max_length=256)]
    """In the order of their times; an estimator that makes no measurements of its own has none. Where they go back behind others,
    they take the place of those."""
    rejected: dict[Name, Annotated[int, Meta(ge=0)]]
    """Measurements that were not used since the estimator's start, by reason."""


class SessionFields(Struct, frozen=True, kw_only=True):
    """What a rig tells of its session; a field that is left out stays as it was."""

    kind: Literal["live", "replay"] | UnsetType = UNSET
    log: Name | UnsetType | None = UNSET
    duration_s: Seconds | UnsetType = UNSET
    estimator: Name | UnsetType = UNSET
    estimators: list[Name] | UnsetType = UNSET
    unavailable: dict[Name, Sentence] | UnsetType = UNSET
    playback: Playback | UnsetType | None = UNSET
    anchor: Literal["site", "here"] | UnsetType = UNSET
    utc_offset_s: Offset | UnsetType | None = UNSET
    notice: Sentence | UnsetType | None = UNSET
    health: dict[Name, SensorHealth] | UnsetType = UNSET
    sharing: bool | UnsetType = UNSET
    """Whether everybody who watches sees the camera picture; else the walker's own view alone."""

    def given(self) -> dict[str, Any]:
        """Return the fields that were given, as JSON values."""
        names = SessionFields.__struct_fields__
        values = {name: getattr(self, name) for name in names}
        return {name: msgspec.to_builtins(value) for name, value in values.items() if value is not UNSET}


class StateUpdate(SessionFields, frozen=True, kw_only=True, tag_field="type", tag="state"):
    """A rig's news: fields of the session at the top level, or under `session`."""

    session: SessionFields | UnsetType = UNSET

    def changes(self) -> dict[str, Any]:
        """Return every field that the message gives."""
        nested = {} if self.session is UNSET else self.session.given()
        return nested | self.given()


class Session(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A session, as viewers and `/api/sessions` get it: every field, always."""

    name: Name
    """Its address: `/ws/view/NAME`."""
    title: Name | None
    """What an operator calls it, to be read in the place of its name; null for nothing."""
    kind: Literal["live", "replay"]
    log: Name | None
    """The recording that is played; null for a live walk."""
    duration_s: Seconds
    estimator: Name
    estimators: list[Name]
    unavailable: dict[Name, Sentence]
    """Estimators that this session cannot run, with the reason."""
    playback: Playback | None
    """Null for a live walk."""
    anchor: Literal["site", "here"]
    utc_offset_s: Offset | None
    """What a picture's stamp needs for the seconds since 1970 (UTC), by which the sun is found; null where nobody knows."""
    notice: Sentence | None
    """What whoever watches should know."""
    health: dict[Name, SensorHealth]
    """How a live rig's sensors are, by name; empty for a replay."""
    sharing: bool
    """Whether everybody who watches sees the camera picture; else the walker's own view alone."""
    connected: bool
    """Whether the rig is there."""


class Hello(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="hello"):
    """The first message to a viewer."""

    version: int
    """Of the wire format, on this connection."""
    role: Role
    """As whom this viewer is here; `rig` is the walker, who alone switches sharing."""
    sees: bool
    """Whether this viewer gets the camera picture though it is not shared; else an empty one stands in its place."""
    number: int
    """Of this viewer among those who watch, from one; see `Company`."""
    session: Session


class SessionNews(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="state"):
    """The session has changed: the whole of it anew."""

    session: Session


FromRig: TypeAlias = StateUpdate | ControlReply | Figures
FromViewer: TypeAlias = Ack | ControlRequest | Look

_FROM_VIEWER: msgspec.json.Decoder[FromViewer] = msgspec.json.Decoder(FromViewer)
_FROM_RIG: msgspec.json.Decoder[FromRig] = msgspec.json.Decoder(FromRig)
_CONTROL: msgspec.json.Decoder[ControlRequest] = msgspec.json.Decoder(ControlRequest)


def parse_from_viewer(text: str) -> FromViewer:
    """Read what a viewer may say; `MalformedMessage` for everything else."""
    return _parse(_FROM_VIEWER, text, MAX_VIEWER_TEXT)


def parse_from_rig(text: str) -> FromRig:
    """Read what a rig may say; `MalformedMessage` for everything else."""
    return _parse(_FROM_RIG, text, MAX_RIG_TEXT)


def parse_control(text: str) -> ControlRequest:
    """Read what the server may say to a rig; `MalformedMessage` for everything else."""
    return _parse(_CONTROL, text, MAX_VIEWER_TEXT * 2)


def encode(message: Struct) -> str:
    """Return a message as JSON."""
    return msgspec.json.encode(message).decode()


def hello(session: dict[str, Any], *, role: Role, sees: bool, number: int) -> str:
    """Return the first message to a viewer, see `Hello`."""
    message = {"type": "hello", "version": VERSION, "role": role, "sees": sees, "number": number, "session": session}
    return msgspec.json.encode(message).decode()


def state(session: dict[str, Any]) -> str:
    """Return the message that tells viewers of a change."""
    return msgspec.json.encode({"type": "state", "session": session}).decode()


def _parse(decoder: "msgspec.json.Decoder[T]", text: str, max_length: int) -> T:
    if len(text) > max_length:
        raise MalformedMessage(f"expected a text message of at most {max_length} characters, got {len(text)}")
    try:
        return decoder.decode(text)
    except (msgspec.MsgspecError, ValueError, RecursionError) as exc:
        raise MalformedMessage(f"no message of version {VERSION}: {exc}") from exc
