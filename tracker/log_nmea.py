"""A receiver's own sentences in a log, `/gps/nmea`: where it has said where it is, they are the source of fixes and velocities."""

from collections import Counter
from collections.abc import Iterator, Mapping

from tracker import ros_messages as ros
from tracker.errors import MalformedInput
from tracker.measurements import GpsFix, GpsVelocity
from tracker.sources.nmea import NmeaReader

TOPIC = "/gps/nmea"
#: What a reading left out, by the reader's reasons.
_LEFT_OUT = ("checksum", "cut", "not_text", "noise", "too_long", "unreadable")


class LoggedSentences:
    """One pass over a log's sentences."""

    def __init__(self) -> None:
        self._reader = NmeaReader()

    def take(self, message: ros.RosMessage, t_recv_ns: int) -> list[GpsFix | GpsVelocity]:
        """Return what one message completes.

        Its stamp counts as the time at which it was said: drivers stamp with the receipt, converters with the time of the position,
        and both lead to the same line between the receiver's clock and the log's. A stamp of zero is none.
        """
        line = str(message.sentence).strip().encode() + b"\r\n"
        return self._reader.feed(line, t_recv_ns, ros.stamp_ns(message.header.stamp) or t_recv_ns)

    def close(self, t_recv_ns: int) -> list[GpsFix | GpsVelocity]:
        """Return what the log's end completes."""
        return self._reader.close(t_recv_ns)

    @property
    def left_out(self) -> Mapping[str, int]:
        """How many sentences could not be read, by reason."""
        counts = self._reader.counts
        return {f"nmea_{reason}": counts[reason] for reason in _LEFT_OUT if counts[reason]}


class SentenceContents:
    """What the pass over a newly opened log finds in its sentences, without reading more of them than it must."""

    def __init__(self) -> None:
        self._kinds: Counter[bytes] = Counter()
        self._sentences: LoggedSentences | None = LoggedSentences()
        self.first_fix: GpsFix | None = None

    def visit(self, data: bytes, t_recv_ns: int) -> None:
        """Take note of one message; all are read until the first fix."""
        self._kinds.update(_kind(data))
        if self._sentences is None:
            return
        try:
            found = self._sentences.take(ros.decode(data, ros.SENTENCE), t_recv_ns)
        except MalformedInput:
            return  # counted when it is read
        for measurement in found:
            if isinstance(measurement, GpsFix) and measurement.valid:
                self.first_fix, self._sentences = measurement, None
                return

    @property
    def fixes(self) -> int:
        """How many positions are said, valid or not; none: then the log's other topics count."""
        return self._kinds[b"GGA"] or self._kinds[b"RMC"]

    @property
    def velocities(self) -> int:
        """How many velocities are said."""
        return self._kinds[b"RMC"] or self._kinds[b"VTG"]


def _kind(data: bytes) -> Iterator[bytes]:
    at = data.find(b"$")
    if at >= 0:
        yield data[at + 3 : at + 6]
