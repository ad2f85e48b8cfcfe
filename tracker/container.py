"""An MCAP file as messages in order of arrival, read so that damage costs only what it touched.

The index at a file's end is not used: a walk that was cut off has none, and walking over the records of a whole one costs
milliseconds. `mcap` reads each record; this file knows where they lie.
"""

import heapq
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from os import SEEK_END
from pathlib import Path
from struct import Struct
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, breakup_chunk

from tracker.errors import MalformedInput
from tracker.salvage import cut_chunk

_MAGIC = b"\x89MCAP0\r\n"
#: A record that claims more than this is damage.
_LARGEST_RECORD = 1 << 30
_LARGEST_CHUNK = 1 << 30
#: The last record of a whole file: opcode, length, where the summary begins, its offsets, its checksum.
_FOOTER = Struct("<BQQQI")


@dataclass(frozen=True, slots=True)
class Stored:
    """A message as the file holds it."""

    topic: str
    ros_type: str
    t_recv_ns: int
    data: bytes


@dataclass(frozen=True, slots=True)
class _Span:
    """A chunk: where it lies and the arrival times that it covers."""

    offset: int
    start_ns: int
    end_ns: int


class Container:
    """The messages of one file. Opening it reads every message once and keeps none."""

    def __init__(self, path: Path, visit: Callable[[Stored], None]) -> None:
        """Open a file and show every message to `visit`, in the file's order.

        Raises:
            MalformedInput: The file is not there, cannot be read or is no MCAP.
        """
        self.path = path
        self.truncated = False
        self.damage: Counter[str] = Counter()
        """Chunks that did not read."""
        self.metadata: dict[str, dict[str, str]] = {}
        """What the recorder says of the whole, by name."""
        self._spans: list[_Span] = []
        self._channels: dict[int, tuple[str, str]] = {}
        self._schemas: dict[int, str] = {}
        self._loose: list[Stored] = []
        """Messages outside whole chunks: few recorders write them, but the last chunk of a cut file is here."""
        with _open(path) as file:
            self._learn_summary(file)
            self._scan(file, visit)
        self._spans.sort(key=lambda span: span.start_ns)
        self._loose.sort(key=lambda stored: stored.t_recv_ns)

    def messages(self, start_ns: int = 0, wanted: Callable[[str], bool] = lambda topic: True) -> Iterator[Stored]:
        """Yield the messages that arrived at or after start_ns, in order of arrival, of wanted topics."""
        heap: list[tuple[int, int, Stored]] = [
            (stored.t_recv_ns, number, stored) for number, stored in enumerate(self._loose)
        ]
        number = len(heap)
        with _open(self.path) as file:
            for span in self._spans:
                if span.end_ns < start_ns:
                    continue
                while heap and heap[0][0] < span.start_ns:
                    yield from _from(start_ns, wanted, heapq.heappop(heap)[2])
                for stored in self._chunk(file, span):
                    if wanted(stored.topic):
                        heapq.heappush(heap, (stored.t_recv_ns, number, stored))
                        number += 1
        while heap:
            yield from _from(start_ns, wanted, heapq.heappop(heap)[2])

    def _chunk(self, file: BinaryIO, span: _Span) -> list[Stored]:
        file.seek(span.offset)
        try:
            record = next(_reader(file).records, None)
            return self._open_chunk(record) if isinstance(record, Chunk) else []
        except Exception:  # what damaged bytes make zstd, lz4 and mcap raise; counted when the file was opened
            return []

    def _learn_summary(self, file: BinaryIO) -> None:
        """Learn channels from their copies at the end of a whole file: their first mention may lie in a damaged chunk."""
        try:
            file.seek(-_FOOTER.size - len(_MAGIC), SEEK_END)
            opcode, _, summary_start, _, _ = _FOOTER.unpack(file.read(_FOOTER.size))
            if opcode != Opcode.FOOTER or summary_start == 0:
                return
            file.seek(summary_start)
            for record in _reader(file).records:
                self._learn(record)
        except Exception:  # no summary, or bytes that are none: the chunks have to do
            return

    def _scan(self, file: BinaryIO, visit: Callable[[Stored], None]) -> None:
        file.seek(len(_MAGIC))
        records = _reader(file).records
        while True:
            offset = file.tell()
            try:
                record = next(records)
            except StopIteration:
                self.truncated = not _ends_whole(file)
                return
            except Exception:  # the end of a cut file, or bytes that are no record
                self.truncated = True
                for rest in cut_chunk(file, offset):
                    self._scan_loose(rest, visit)
                return
            if isinstance(record, Chunk):
                self._scan_chunk(record, offset, visit)
            else:
                self._scan_loose(record, visit)

    def _scan_loose(self, record: object, visit: Callable[[Stored], None]) -> None:
        for stored in self._learn(record):
            self._loose.append(stored)
            visit(stored)

    def _scan_chunk(self, chunk: Chunk, offset: int, visit: Callable[[Stored], None]) -> None:
        try:
            stored = self._open_chunk(chunk)
        except Exception:
            self.damage["corrupt_chunk"] += 1
            return
        if stored:
            times = [message.t_recv_ns for message in stored]
            self._spans.append(_Span(offset, min(times), max(times)))
            for message in stored:
                visit(message)

    def _open_chunk(self, chunk: Chunk) -> list[Stored]:
        if chunk.uncompressed_size > _LARGEST_CHUNK:
            raise McapError("a chunk this large is damage")
        return [stored for record in breakup_chunk(chunk, validate_crc=True) for stored in self._learn(record)]

    def _learn(self, record: object) -> list[Stored]:
        """Remember schemas, channels and metadata; return the message in a record."""
        if isinstance(record, Metadata):
            self.metadata[record.name] = record.metadata
        elif isinstance(record, Schema):
            self._schemas[record.id] = record.name
        elif isinstance(record, Channel):
            ros_type = self._schemas.get(record.schema_id, "")
            self._channels[record.id] = (record.topic, ros_type if record.message_encoding == "cdr" else "")
        elif isinstance(record, Message) and record.channel_id in self._channels:
            topic, ros_type = self._channels[record.channel_id]
            return [Stored(topic, ros_type, record.log_time, record.data)]
        return []


def _open(path: Path) -> BinaryIO:
    try:
        file = path.open("rb")
        magic = file.read(len(_MAGIC))
    except FileNotFoundError as error:
        raise MalformedInput(f"There is no file {path}: check the name and the folder.") from error
    except OSError as error:
        raise MalformedInput(f"{path} cannot be read: {error.strerror}.") from error
    if magic != _MAGIC:
        file.close()
        raise MalformedInput(f"{path} is not an MCAP file: give a walk that was recorded as a ROS 2 bag in MCAP.")
    return file


def _reader(file: BinaryIO) -> StreamReader:
    return StreamReader(file, skip_magic=True, emit_chunks=True, record_size_limit=_LARGEST_RECORD)


def _ends_whole(file: BinaryIO) -> bool:
    file.seek(0, 2)
    size = file.tell()
    file.seek(max(0, size - len(_MAGIC)))
    return file.read() == _MAGIC


def _from(start_ns: int, wanted: Callable[[str], bool], stored: Stored) -> Iterator[Stored]:
    if stored.t_recv_ns >= start_ns and wanted(stored.topic):
        yield stored
