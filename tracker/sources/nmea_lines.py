"""Bytes of a receiver into NMEA 0183 sentences, however they are split; what is no whole sentence is counted by reason."""

import re
from collections import Counter
from collections.abc import Iterator
from functools import reduce
from operator import xor

#: The standard allows 82 characters; receivers with many satellites write some more.
_LONGEST = 512
_EDGE = re.compile(rb"([\r\n$])")
_SENTENCE = re.compile(rb"([^*]*)\*([0-9A-Fa-f]{2})[ \t]*")


class NmeaLines:
    """Sentences out of a stream. A sentence begins at a `$` and ends at a line's end or at the next `$`.

    Counted are: `checksum` (it is wrong), `cut` (no checksum at the end: a part is missing), `too_long`, `not_text` (the
    checksum is right by chance), and `noise` (a line, or what stands before a `$`, that is no sentence at all).
    """

    def __init__(self, counts: Counter[str]) -> None:
        self._counts = counts
        self._body: bytearray | None = None
        self._t_ns = 0
        self._is_noisy = False
        self._is_passed_over = False

    def feed(self, data: bytes, t_ns: int) -> Iterator[tuple[str, int]]:
        """Yield what stands between `$` and `*` in each sentence that ends here, and the `t_ns` of where it began."""
        for part in _EDGE.split(data):
            if part in (b"\r", b"\n", b"$"):
                yield from self.close()
                if part == b"$":
                    self._body, self._t_ns = bytearray(), t_ns
            elif part:
                self._extend(part)

    def close(self) -> Iterator[tuple[str, int]]:
        """End the line: the stream may end without a line's end."""
        if self._is_noisy:
            self._counts["noise"] += 1
        self._is_noisy = self._is_passed_over = False
        if self._body is not None:
            content = self._checked(bytes(self._body))
            self._body = None
            if content is not None:
                yield content, self._t_ns

    def _extend(self, part: bytes) -> None:
        if self._body is None:
            self._is_noisy = self._is_noisy or not (self._is_passed_over or part.isspace())
            return
        self._body += part
        if len(self._body) > _LONGEST:
            self._counts["too_long"] += 1
            self._body, self._is_passed_over = None, True

    def _checked(self, body: bytes) -> str | None:
        whole = _SENTENCE.fullmatch(body)
        if whole is None:
            self._counts["cut"] += 1
        elif reduce(xor, whole[1], 0) != int(whole[2], 16):
            self._counts["checksum"] += 1
        elif not whole[1].isascii() or not whole[1].decode("ascii").isprintable():
            self._counts["not_text"] += 1
        else:
            return whole[1].decode("ascii")
        return None
