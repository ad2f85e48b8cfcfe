"""One session: a rig, its newest frame and state, and the mailboxes of those who watch. For one event loop, no locks, no I/O.

Frames and poses go out in the loop's next turn: of those that a rig's connection has piled up by then, the newest alone.
"""

import asyncio
from collections.abc import Callable
from typing import Any, Final

from server import messages
from server.company import Watchers
from server.errors import ServerFull
from server.fanout import Mailbox
from server.grants import ABILITIES
from server.listener import Listener, Nobody
from server.messages import ControlReply, ControlRequest, Figures, Look, StateUpdate
from server.privacy import without_picture
from server.traffic import Tally
from server.wire import decode_frame, decode_pose, is_frame, keep_seek

MAX_VIEWERS: Final = 64
MAX_PENDING: Final = 64
#: Close code of our own: another rig has taken the session.
REPLACED: Final = 4409

_DEFAULTS: Final[dict[str, Any]] = {
    "kind": "live",
    "log": None,
    "duration_s": 0.0,
    "estimator": "",
    "estimators": [],
    "unavailable": {},
    "playback": None,
    "anchor": "site",
    "utc_offset_s": None,
    "notice": None,
    "health": {},
    "sharing": False,
}
_AWAITED: Final = "The rig has not come yet."
_LEFT: Final = "The rig has left: what is shown is the last that it sent."
_OPERATORS: Final = ("settings", "figures")
Later = Callable[[Callable[[], None]], object]


def next_turn(call: Callable[[], None]) -> None:
    """Call something in the event loop's next turn."""
    asyncio.get_running_loop().call_soon(call)


class Session:
    """One walk, as the server knows it."""

    def __init__(
        self,
        name: str,
        max_viewers: int = MAX_VIEWERS,
        sent: Callable[[bool, int], None] = lambda is_frame, t_ns: None,
        later: Later = next_turn,
        listener: Listener | None = None,
    ) -> None:
        self.name = name
        self._listener = listener or Nobody()
        self._max_viewers, self._sent, self._later = max_viewers, sent, later
        self.frames = 0
        """Frames that came from the rig."""
        self.t_frame_ns: int | None = None
        """When the newest came, on the clock that `take_binary` is given."""
        self.poses = 0
        """Poses that came from the rig, by themselves."""
        self.t_pose_ns: int | None = None
        """When the newest came, by itself or with a frame."""
        self.received_bytes = 0
        self.tally = Tally()
        """What went to viewers."""
        self.viewers: set[Mailbox] = set()
        self._figure_readers: set[Mailbox] = set()
        self._watchers = Watchers()
        self.elsewhere = False
        """Whether the word on it is with another server, which its rig was last connected to."""
        self.title: str | None = None
        """What an operator calls it, in the place of its name."""
        self._fields = dict(_DEFAULTS)
        self._came = False
        self._rig: Mailbox | None = None
        self._frame: tuple[int, bytes] | None = None
        self._hidden: bytes | None = None
        """That frame without its picture, once somebody needed it."""
        self._pose: bytes | None = None
        self._new_frame: tuple[int, bytes, int] | None = None
        """What is to go out in the next turn: id, frame and when it came."""
        self._new_pose: tuple[bytes, int] | None = None
        self._pending: dict[str, tuple[Mailbox, str]] = {}
        self._requests = 0

    @property
    def connected(self) -> bool:
        """Whether a rig is there."""
        return self._rig is not None

    @property
    def fields(self) -> dict[str, Any]:
        """What its rig has told, see `messages.SessionFields`."""
        return self._fields

    @property
    def newest_pose(self) -> bytes | None:
        """The last that came by itself."""
        return self._pose

    def newest_frame(self, *, sees: bool, empty: bool = False) -> bytes | None:
        """Return the last that came, as somebody may see it who does or does not see the walker's picture, or wants none."""
        if self._frame is None:
            return None
        if (sees or self.sharing) and not empty:
            return self._frame[1]
        self._hidden = self._hidden or without_picture(self._frame[1])  # made once for all
        return self._hidden

    @property
    def playing(self) -> bool:
        """Whether frames are to be expected."""
        playback = self._fields["playback"]
        return self.connected and (playback is None or bool(playback["playing"]))

    def describe(self) -> dict[str, Any]:
        """Return the session as viewers and `/api/sessions` get it."""
        session = {"name": self.name, "title": self.title, **self._fields, "connected": self.connected}
        if not self.connected:
            session["notice"] = _LEFT if self._came else _AWAITED
            if session["playback"] is not None:
                session["playback"] = session["playback"] | {"playing": False}
        return session

    @property
    def sharing(self) -> bool:
        """Whether the walker lets everybody who watches see the picture."""
        return bool(self._fields["sharing"])

    # -- the rig ------------------------------------------------------------------------------------------------------

    def attach_rig(self, rig: Mailbox) -> None:
        """Give the session to a rig; the one that had it is closed."""
        if self._rig is not None:
            self._rig.close(REPLACED, "another rig took this session")
            self._fail_pending()
        self._rig, self._came, self.elsewhere = rig, True, False
        self._change({"sharing": False})  # whoever had it may have shared; this rig says so itself, if it does

    def detach_rig(self, rig: Mailbox) -> None:
        """Note that a rig is gone and tell the viewers; nothing happens where another has its place."""
        if self._rig is rig:
            self._rig = None
            self._fail_pending()
            self._change({"sharing": False})  # nobody is left who could switch it off

    def take_text(self, text: str) -> None:
        """Take a rig's text message; `MalformedMessage` where it is none."""
        message = messages.parse_from_rig(text)
        if isinstance(message, StateUpdate):
            self._change(message.changes())
        elif isinstance(message, Figures):
            for viewer in self._figure_readers:
                viewer.put_text(text)
        else:
            self._relay_reply(message)

    def take_binary(self, data: bytes, t_ns: int) -> None:
        """Take a rig's frame or pose and hand it to every viewer; `MalformedMessage` where it is neither."""
        goes_already = self._new_frame is not None or self._new_pose is not None
        if is_frame(data):
            meta = decode_frame(data)[0]
            data = keep_seek(self._new_frame[1] if self._new_frame else None, data)
            self._frame, self.t_frame_ns = (meta.frame_id, data), t_ns
            self._new_frame = (meta.frame_id, data, t_ns)
            self._hidden = None
            self.frames += 1
            if meta.pose_valid:
                self.t_pose_ns = t_ns
        else:
            decode_pose(data)
            self._pose, self.t_pose_ns = data, t_ns
            self._new_pose = (data, t_ns)
            self.poses += 1
        self.received_bytes += len(data)
        if not goes_already:
            self._later(self._fan_out)

    def mirror(self, title: str | None, fields: dict[str, Any], rig: Mailbox | None) -> None:
        """Be what the session is at the server where its rig is; `rig` is a way to that one, None where it has gone.

        A rig that is connected here has been taken over by the other server, and is closed.
        """
        if self._rig is not None and self._rig is not rig:
            self._rig.close(REPLACED, "another rig took this session")
            self._fail_pending()
        self._rig, self._came, self.elsewhere, self.title = rig, True, True, title
        self._change(fields)

    def expect(self, fields: dict[str, Any]) -> None:
        """Note what is known of a rig that has not come yet (see `messages.SessionFields`)."""
        self._fields |= fields

    # -- the viewers --------------------------------------------------------------------------------------------------

    def join(self, viewer: Mailbox) -> None:
        """Add a viewer, who gets at once what all the others have; `ServerFull` where there are too many.

        One who does not see (`Mailbox.sees`) gets each frame with an empty picture, unless the walker shares it.
        """
        if len(self.viewers) >= self._max_viewers:
            raise ServerFull(f"{self._max_viewers} viewers watch already: try again when one has left.")
        self.viewers.add(viewer)
        viewer.tally, viewer.sent = self.tally, self._sent
        number = self._watchers.join(viewer)
        viewer.put_text(messages.hello(self.describe(), role=viewer.role, sees=viewer.sees, number=number))
        viewer.put_company(self._watchers.message())
        self._show(viewer)
        if self._pose is not None:
            viewer.put_pose(self._pose)
        self._listener.watched(self)

    def leave(self, viewer: Mailbox) -> None:
        """Forget a viewer and what it asked for."""
        self.viewers.discard(viewer)
        self._figure_readers.discard(viewer)
        self._watchers.leave(viewer)
        self._listener.watched(self)
        self._pending = {key: asked for key, asked in self._pending.items() if asked[0] is not viewer}

    def look(self, viewer: Mailbox, look: Look, t_ns: int) -> None:
        """Note from where a viewer looks on, for the others."""
        self._watchers.take(viewer, look, t_ns)
        self._tell_company(t_ns)

    def control(self, viewer: Mailbox, request: ControlRequest) -> None:
        """Forward a viewer's request to the rig under a number of our own: two viewers may choose the same."""
        error = self._refusal(viewer, request)
        if error is not None or self._rig is None:
            error = error or "No rig is connected."
            viewer.put_text(messages.encode(ControlReply(request.request_id, ok=False, error=error)))
            return
        if request.action == "figures":
            self._figure_readers.add(viewer)
        self._requests += 1
        key = str(self._requests)
        self._pending[key] = (viewer, request.request_id)
        self._rig.put_text(messages.encode(ControlRequest(key, request.action, request.value)))

    # -----------------------------------------------------------------------------------------------------------------

    def _refusal(self, viewer: Mailbox, request: ControlRequest) -> str | None:
        if request.action in _OPERATORS and "operate" not in ABILITIES[viewer.role]:
            return "Only operators look into the tracker and change its settings."
        return "The rig is busy: try again." if len(self._pending) >= MAX_PENDING else None

    def rename(self, title: str) -> None:
        """Call it something; nothing for its name again. Its address stays: rigs and viewers need not know."""
        if not self._listener.renames(self, title):
            self.title = title or None
            self._tell()

    def end(self, code: int, reason: str) -> None:
        """Tell viewers why it ends, and close them and the rig with that code."""
        last = messages.state(self.describe() | {"connected": False, "notice": reason})
        for viewer in self.viewers:
            viewer.close(code, reason, last)
        if self._rig is not None:
            self._rig.close(code, reason)

    def _fan_out(self) -> None:
        """Hand the newest frame and the newest pose to every viewer."""
        frame, pose, self._new_frame, self._new_pose = self._new_frame, self._new_pose, None, None
        if frame is not None:
            for viewer in self.viewers:
                self._show(viewer, frame[2])
        if pose is not None:
            for viewer in self.viewers:
                viewer.put_pose(*pose)
        for news in (frame, pose):
            if news is not None:
                self._tell_company(news[-1])
        self._listener.fanned_out(self, frame is not None, pose is not None)

    def _show(self, viewer: Mailbox, t_ns: int | None = None) -> None:
        """Give a viewer the newest frame, as it may see it."""
        if viewer.frames_wanted == 0:
            return
        data = self.newest_frame(sees=viewer.sees, empty=viewer.frames_wanted is not None)
        if self._frame is None or data is None:
            return
        if viewer.frames_wanted is not None:
            viewer.frames_wanted -= 1
        viewer.put_frame(self._frame[0], data, t_ns)

    def _change(self, fields: dict[str, Any]) -> None:
        before = self.sharing
        self._fields |= fields
        self._tell()
        if self.sharing != before:
            for viewer in self.viewers:
                if not viewer.sees:
                    self._show(viewer)  # in the place of one that waits

    def _tell(self) -> None:
        text = messages.state(self.describe())
        for viewer in self.viewers:
            viewer.put_text(text)
        self._listener.changed(self)

    def _tell_company(self, t_ns: int) -> None:
        """Tell everybody who watches, where that is news."""
        if (news := self._watchers.news(t_ns)) is not None:
            for viewer in self.viewers:
                viewer.put_company(news)

    def _relay_reply(self, reply: ControlReply) -> None:
        if asked := self._pending.pop(reply.request_id, None):
            viewer, request_id = asked
            viewer.put_text(messages.encode(ControlReply(request_id, reply.ok, reply.error, reply.did_seek)))

    def _fail_pending(self) -> None:
        for key in list(self._pending):
            self._relay_reply(ControlReply(key, ok=False, error="The rig left before it answered."))
