"""A rig's side of `/ws/rig/{session}`: frame messages made, and pushed over a link that mends itself.

Two threads: `rig-link` connects and sends, `rig-control` reads requests and answers them.
"""

import logging
import socket
import ssl
import struct
from collections.abc import Callable
from contextlib import suppress
from threading import Thread
from time import monotonic
from types import TracebackType
from typing import Any, Final, Self

import numpy as np
from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from server.errors import LinkRefused, MalformedMessage
from server.messages import ControlReply, ControlRequest, encode, parse_control
from server.outbox import Outbox
from server.session import REPLACED
from server.sessions import ENDED
from server.wire import SUBPROTOCOL, FrameMeta, PoseUpdate, encode_frame, encode_pose
from tracker.errors import InputError, MissingSensor
from tracker.estimator import NO_MOTION_MODEL, Pose
from tracker.geometry import transform
from tracker.measurements import Frame
from tracker.rig import Rig

_logger = logging.getLogger(__name__)

_FIRST_PAUSE_S: Final = 0.1
_LONGEST_PAUSE_S: Final = 1.0
#: A connection that has lasted so long was a good one.
_GOOD_S: Final = 5.0
#: A network that has vanished without a word is noticed when nothing could be sent for so long, and the server is looked for anew.
_STUCK_S = 5
#: A server that says nothing back for so long has gone, even where bytes still find a place on the way.
_PING_S, _PONG_S = 5.0, 10.0
#: What may lie in the kernel on its way out, bytes: two or three pictures. More would be old when it arrives.
_UNDER_WAY: Final = 128 * 1024
_FAREWELL_S: Final = 2.0
_MAX_CONTROL_BYTES: Final = 16 * 1024
#: Refusals that will not change by asking again.
_FINAL_STATUS: Final = (401, 403, 404, 406)
_TRUTH: Final = "truth"


def frame_message(
    frame: Frame,
    pose: Pose | None,
    rig: Rig,
    *,
    estimator: str,
    position_s: float,
    t_sent_ns: int,
    quarter_turns: int = 0,
    did_seek: bool = False,
) -> bytes:
    """Return the frame message of a picture with the pose of its own capture.

    Args:
        frame: The picture.
        pose: The pose at `frame.t_ns`; None before there is one (the identity then travels, marked as no pose).
        rig: Its camera, and where that stands on the body.
        estimator: Name; `truth` marks the pose as ground truth.
        position_s: Seconds from the start of the log or walk.
        t_sent_ns: The monotonic clock now.
        quarter_turns: Clockwise 90° turns that make the picture upright.
        did_seek: A seek came just before.

    Raises:
        MissingSensor: The rig's camera has no intrinsics.
        MalformedInput: The picture does not decode.
        ValueError: A number that the wire cannot carry.
    """
    if rig.camera is None:
        raise MissingSensor(
            "The camera's intrinsics are unknown, so nothing can be drawn over it: calibrate the camera."
        )
    T_site_cam = np.eye(4) if pose is None else transform(pose.wxyz_site_body, pose.p_site_m) @ rig.T_body_cam
    meta = FrameMeta(
        frame_id=frame.frame_id,
        t_capture_ns=frame.t_ns,
        t_sent_ns=t_sent_ns,
        T_site_cam=T_site_cam,
        cov=np.zeros((6, 6)) if pose is None else pose.cov,
        camera=rig.camera,
        motion_model=NO_MOTION_MODEL if pose is None else pose.motion_model,
        estimator=estimator,
        v_site_m_s=(0.0, 0.0, 0.0) if pose is None else pose.v_site_m_s,
        position_s=position_s,
        quarter_turns=quarter_turns,
        pose_valid=pose is not None,
        heading_known=pose is not None and pose.heading_known,
        is_truth=estimator == _TRUTH,
        did_seek=did_seek,
    )
    return encode_frame(meta, frame.picture.jpeg())


def pose_message(pose: Pose, *, seq: int, estimator: str, did_seek: bool = False) -> bytes:
    """Return the pose message of the newest estimate; `ValueError` for a number that the wire cannot carry."""
    a, b, c, d, e, f = pose.cov.diagonal().tolist()
    update = PoseUpdate(
        seq=seq,
        t_ns=pose.t_ns,
        p_site_body_m=pose.p_site_m,
        wxyz_site_body=pose.wxyz_site_body,
        variance=(a, b, c, d, e, f),
        v_site_m_s=pose.v_site_m_s,
        motion_model=pose.motion_model,
        heading_known=pose.heading_known,
        is_truth=estimator == _TRUTH,
        did_seek=did_seek,
    )
    return encode_pose(update)


class RigLink:
    """Pushes frames, poses and state to a server, and answers its requests; mends itself with growing pauses.

    No `send_…` ever waits for the network. `on_control` runs on the link's own thread, one request at a time; an `InputError`
    from it becomes the reply's error.
    """

    def __init__(
        self, url: str, token: str, on_control: Callable[[ControlRequest], ControlReply], trust: str | None = None
    ) -> None:
        """Start connecting.

        Args:
            url: `ws://HOST:PORT/ws/rig/SESSION`, or `wss://…`.
            token: Of that session.
            on_control: Answers viewers' requests.
            trust: The one certificate, PEM, that the server must show whatever its name: a rig beside its own server calls that by
                an address that no certificate is for. None for those of the machine's authorities.
        """
        self._context = None if trust is None else pinned(trust)
        self._url = url
        self._token = token
        self._on_control = on_control
        self._outbox = Outbox()
        self._connection: ClientConnection | None = None
        self.refused: LinkRefused | None = None
        """Why the link gave up for good, where it did."""
        self._thread = Thread(target=self._run, name="rig-link", daemon=True)
        self._thread.start()

    @property
    def connected(self) -> bool:
        """Whether there is a connection now."""
        return self._connection is not None

    def send_frame(self, data: bytes) -> None:
        """Send a frame message; a newer one takes its place where it has not gone yet."""
        self._outbox.put_frame(data)

    def send_pose(self, data: bytes) -> None:
        """Send a pose message; a newer one takes its place where it has not gone yet."""
        self._outbox.put_pose(data)

    def send_state(self, changes: dict[str, Any]) -> None:
        """Send fields of the session (see `messages.SessionFields`), in order and without loss, also over a reconnection."""
        self._outbox.put_state(changes)

    def send_text(self, text: str) -> None:
        """Send a text message that is worth nothing to a later connection, and so is dropped where there is none."""
        if self.connected:
            self._outbox.put_text(text)

    def close(self) -> None:
        """Send the texts that wait, hang up and wait for the threads. May be called twice."""
        self._outbox.close()
        self._thread.join(_FAREWELL_S)
        if self._thread.is_alive() and (connection := self._connection) is not None:
            with suppress(OSError):  # a send that waits for a server that does not read
                connection.socket.shutdown(socket.SHUT_RDWR)
        self._thread.join()

    def __enter__(self) -> Self:
        """Nothing more: the link runs since it was made."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""
        self.close()

    # -- the threads --------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        pause_s = _FIRST_PAUSE_S
        while not self._outbox.closed and self.refused is None:
            try:
                t_begin_s = monotonic()
                self._exchange(self._connect())
                # A server that hangs up at once is not asked again at once.
                pause_s = _FIRST_PAUSE_S if monotonic() - t_begin_s > _GOOD_S else pause_s
            except InvalidStatus as exc:
                self._note_refusal(exc)
            except (OSError, WebSocketException) as exc:
                _logger.debug("no connection to %s: %s", self._url, exc)
            if self.refused is None and not self._outbox.wait_closed(pause_s):
                pause_s = min(2.0 * pause_s, _LONGEST_PAUSE_S)

    def _connect(self) -> ClientConnection:
        connection = connect(
            self._url,
            additional_headers={"Authorization": f"Bearer {self._token}"},
            ssl=self._context,
            subprotocols=[Subprotocol(SUBPROTOCOL)],
            compression=None,  # pictures are compressed already
            proxy=None,
            open_timeout=5.0,
            close_timeout=1.0,
            ping_interval=_PING_S,
            ping_timeout=_PONG_S,
            max_size=_MAX_CONTROL_BYTES,
        )
        connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _UNDER_WAY)
        connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("ll", _STUCK_S, 0))
        return connection

    def _exchange(self, connection: ClientConnection) -> None:
        """Send until the connection or the link ends."""
        self._outbox.begin()
        self._connection = connection
        reader = Thread(target=self._read, args=(connection,), name="rig-control", daemon=True)
        reader.start()
        try:
            while (message := self._outbox.next()) is not None:
                connection.send(message)
        except ConnectionClosed:
            pass  # the reader knows why
        finally:
            connection.close()
            reader.join()
            self._connection = None

    def _read(self, connection: ClientConnection) -> None:
        try:
            for message in connection:
                if isinstance(message, str):
                    self._outbox.put_text(encode(self._answer(message)))
        except ConnectionClosed:
            pass
        finally:
            self._note_close(connection)
            self._outbox.break_off()

    def _answer(self, text: str) -> ControlReply:
        try:
            request = parse_control(text)
        except MalformedMessage as exc:
            return ControlReply("", ok=False, error=str(exc)[:500])
        if request.action == "share":
            return self._share(request)
        try:
            return self._on_control(request)
        except InputError as exc:
            return ControlReply(request.request_id, ok=False, error=str(exc)[:500])
        except Exception:
            _logger.exception("a request could not be answered: %s", request)
            return ControlReply(request.request_id, ok=False, error="The rig failed at this: see its log.")

    def _share(self, request: ControlRequest) -> ControlReply:
        """Let everybody who watches see the picture, or no longer: the rig's own switch, which outlives a server."""
        if not isinstance(request.value, bool):
            return ControlReply(request.request_id, ok=False, error="Sharing is switched by true or false.")
        self.send_state({"sharing": request.value})
        return ControlReply(request.request_id, ok=True)

    def _note_close(self, connection: ClientConnection) -> None:
        if connection.close_code == REPLACED:
            self.refused = LinkRefused(f"Another rig took {self._url}: give this one another session's name.")
            _logger.error("%s", self.refused)
        elif connection.close_code == ENDED:
            self.refused = LinkRefused(f"{self._url} was ended: {connection.close_reason}")
            _logger.warning("%s", self.refused)
        elif connection.close_code not in (1000, 1001, 1012, 1006, None):
            _logger.warning("the server closed the link: %s %s", connection.close_code, connection.close_reason)

    def _note_refusal(self, exc: InvalidStatus) -> None:
        status = exc.response.status_code
        if status in _FINAL_STATUS:
            self.refused = LinkRefused(
                f"The server refused {self._url} ({status}): check its token, its session's name and its version."
            )
            _logger.error("%s", self.refused)


def pinned(certificate: str) -> ssl.SSLContext:
    """Return a context that takes one certificate, and that one only."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    context.load_verify_locations(cadata=certificate)
    return context
