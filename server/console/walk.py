"""One walk as the console knows it, from the messages that every viewer gets. Pure."""

from collections import deque
from dataclasses import dataclass
from typing import Any, Final

import msgspec
import numpy as np

from server.console.history import History
from server.console.path import ColouredPath
from server.errors import MalformedMessage
from server.messages import Company, ControlReply, Figures, Hello, SessionNews
from server.wire import FrameMeta, decode_frame, is_frame

#: An hour at ten pictures a second.
_PLACES: Final = 36_000
_FromServer = Hello | SessionNews | ControlReply | Figures | Company
_DECODER: "msgspec.json.Decoder[_FromServer]" = msgspec.json.Decoder(_FromServer)


class _Kind(msgspec.Struct):
    type: str


_KIND: "msgspec.json.Decoder[_Kind]" = msgspec.json.Decoder(_Kind)
_KNOWN: Final = frozenset(kind.__struct_config__.tag for kind in (Hello, SessionNews, ControlReply, Figures, Company))


@dataclass(frozen=True, slots=True)
class Place:
    """Where the camera was."""

    t_s: float
    p_site_m: tuple[float, float, float]
    sigma_m: float
    motion_model: str


class Walk:
    """What is known of one walk."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.session: dict[str, Any] = {}
        """As `messages.Session` has it; empty before the first message."""
        self.watching = 0
        """Viewers, the console among them."""
        self.sees = False
        """Whether this viewer gets pictures that the walker does not share."""
        self.frame: FrameMeta | None = None
        """The newest."""
        self.jpeg = b""
        self.unacknowledged: list[int] = []
        """Frames that came and were not drawn yet."""
        self.path = ColouredPath()
        self.places: deque[Place] = deque(maxlen=_PLACES)
        """As the path, not thinned out."""
        self.history = History()

    @property
    def title(self) -> str:
        """What people call it."""
        return str(self.session.get("title") or self.name)

    @property
    def is_replay(self) -> bool:
        """Whether it can be paused and sought."""
        return self.session.get("kind") == "replay"

    @property
    def has_picture(self) -> bool:
        """Whether the newest frame's picture is the camera's, and not what stands in its place."""
        return self.frame is not None and (self.sees or bool(self.session.get("sharing")))

    def take_text(self, text: str) -> ControlReply | None:
        """Take a text message; return it where it is a reply. Kinds that are not known are passed over.

        Raises:
            MalformedMessage: It is not of this version.
        """
        try:
            if _KIND.decode(text).type not in _KNOWN:
                return None
            message = _DECODER.decode(text)
        except msgspec.MsgspecError as exc:
            raise MalformedMessage(f"no message to a viewer: {exc}") from exc
        if isinstance(message, ControlReply):
            return message
        if isinstance(message, Figures):
            self.history.take_figures(message)
            return None
        if isinstance(message, Company):
            self.watching = message.watching
            return None
        if isinstance(message, Hello):
            self.sees = message.sees
        self._take_session(msgspec.to_builtins(message.session))
        return None

    def take_frame(self, data: bytes) -> bool:
        """Take a binary message; return whether its path has grown. Poses are passed over: each frame has its own.

        Raises:
            MalformedMessage: It is no frame.
        """
        if not is_frame(data):
            return False
        frame, self.jpeg = decode_frame(data)
        self.frame = frame
        self.unacknowledged.append(frame.frame_id)
        self.history.take_frame(frame)
        if frame.did_seek:
            self.path.lift()
        if not frame.pose_valid:
            return False
        east_m, north_m, up_m = frame.T_site_cam[:3, 3].tolist()
        sigma_m = float(np.sqrt(max(0.0, np.trace(frame.cov[:2, :2]))))
        self.places.append(Place(frame.position_s, (east_m, north_m, up_m), sigma_m, frame.motion_model))
        return self.path.add(frame.T_site_cam[:3, 3], frame.motion_model)

    def _take_session(self, session: dict[str, Any]) -> None:
        if session["estimator"] != self.session.get("estimator"):
            self.path, self.history = ColouredPath(), History()
            self.places.clear()
        self.session = session
