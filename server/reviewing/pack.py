"""A walk as frame messages, one after another, that are played without a server: poses worked out, pictures made smaller."""

import struct
from pathlib import Path
from typing import Final

import cv2
import msgspec
import numpy as np

from assets.site import load_site
from assets.terrain import build_terrain
from server.errors import LogRefused
from server.fitting import best_estimator, display_rig
from server.placing import Placing
from server.privacy import without_picture
from server.push import frame_message
from server.reviewing.jobs import PackJob
from server.standing import eye_heights, origin_of
from server.wire import FRAME_HEADER_BYTES, decode_frame
from tracker.blank import BlankCamera
from tracker.errors import MalformedInput
from tracker.evaluate import make_pipeline
from tracker.log import Log
from tracker.pictures import EncodedPicture
from tracker.pipeline import Pipeline
from tracker.playback import Playback, Recording
from tracker.upright import Upright

_QUALITY: Final = 68
#: A walk shown at fewer pictures a second is no walk any more.
_LEAST_HZ: Final = 1.5
_LENGTH: Final = struct.Struct("<I")


class Packed(msgspec.Struct, frozen=True):
    """What a pack begins with, a line of JSON."""

    estimator: str
    duration_s: float
    utc_offset_s: float | None
    """See `server.messages.Session`."""
    positions_s: list[float]
    """Of each message: seconds from the walk's start."""


def packed(log: Log, job: PackJob) -> bytes:
    """Return a line of JSON, `Packed`, and then each message with its length before it, four bytes, little endian.

    Where all messages are larger than `job.max_bytes`, every other one is left out, or more.

    Raises:
        LogRefused: 413, that would leave too few of them.
        InputError: The estimator cannot run on this walk.
    """
    estimator = job.estimator or best_estimator(log)
    messages = _messages(log, job, estimator)
    size = sum(map(len, messages))
    every = max(1, -(-size // job.max_bytes))
    if every > 1 and len(messages) / every < _LEAST_HZ * log.info.duration_s:
        raise LogRefused(413, _too_long(size, job))
    kept = messages[::every]
    positions_s = [round(decode_frame(message)[0].position_s, 4) for message in kept]
    head = msgspec.json.encode(Packed(estimator, log.info.duration_s, log.info.utc_offset_s, positions_s)) + b"\n"
    return head + b"".join(_LENGTH.pack(len(message)) + message for message in kept)


def unpacked(pack: bytes) -> tuple[Packed, list[bytes]]:
    """Return what `packed` put together."""
    head, _, rest = pack.partition(b"\n")
    messages, at = [], 0
    while at < len(rest):
        (length,) = _LENGTH.unpack_from(rest, at)
        messages.append(rest[at + _LENGTH.size : at + _LENGTH.size + length])
        at += _LENGTH.size + length
    return msgspec.json.decode(head, type=Packed), messages


def _messages(log: Log, job: PackJob, estimator: str) -> list[bytes]:
    site = load_site(Path(job.site))
    placing = Placing(origin_of(site), build_terrain(site).ground_z_m, eye_heights(site), site.eye_height_m, job.anchor)
    rig, info = display_rig(log), log.info
    recording: Recording = log if info.counts["frames"] else BlankCamera(log)
    origin, eyes_z_m = placing.origin(info.first_fix), placing.eyes_for(estimator)

    def pipeline(name: str) -> Pipeline:
        return placing.levelled(make_pipeline(name, log, origin, eyes_z_m=eyes_z_m))

    playback = Playback(recording, info.t_start_ns, pipeline, Upright(log.rig))
    playback.choose(estimator)
    messages = []
    while (shown := playback.step()) is not None:
        try:
            message = frame_message(
                shown.frame,
                placing.placed(shown.pose, estimator),
                rig,
                estimator=estimator,
                position_s=(shown.frame.t_recv_ns - info.t_start_ns) * 1e-9,
                t_sent_ns=shown.frame.t_recv_ns,
                quarter_turns=shown.quarter_turns,
            )
        except MalformedInput:
            continue  # as a replay leaves it out
        if not job.pictures:
            messages.append(without_picture(message))
        elif (small := _smaller(message)) is not None:
            messages.append(small)
    return messages


def _smaller(message: bytes) -> bytes | None:
    """Return the message with its picture compressed further, where that makes it smaller; None where it does not decode."""
    jpeg = message[FRAME_HEADER_BYTES:]
    try:
        pixels = EncodedPicture(jpeg).bgr()
    except MalformedInput:
        return None
    done, data = cv2.imencode(".jpg", pixels, (cv2.IMWRITE_JPEG_QUALITY, _QUALITY))
    small = np.asarray(data).tobytes() if done else jpeg
    return message[:FRAME_HEADER_BYTES] + min(jpeg, small, key=len)


def _too_long(size: int, job: PackJob) -> str:
    megabytes = f"{size / 1e6:.0f} MB of pictures do not fit into {job.max_bytes / 1e6:.0f} MB"
    return f"{megabytes}: allow more, or leave the pictures out."
