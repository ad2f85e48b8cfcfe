"""What comes down a connection to gpsd: a receiver's sentences out, whatever the pieces. No I/O.

gpsd offers what a receiver says (`nmea`) and its own view of it (TPV and SKY as JSON). Of a receiver that speaks NMEA, the
sentences lose least: each is handed on when it is here, where TPV waits for what gpsd takes for an epoch's end, and quality,
dilutions and deviations come with the position that they are of. Of one that speaks a binary protocol, TPV does: see `gpsd_tpv`.
gpsd says which it is (`native`), and in JSON alone that receivers come and go. Sentences with a wrong checksum are refused by gpsd
and never seen.

Reference:
    gpsd_json(5): https://gpsd.gitlab.io/gpsd/gpsd_json.html
"""

import json
from typing import Any

from tracker.errors import MalformedInput
from tracker.sources.gpsd_tpv import sentences

WATCH = b'?WATCH={"enable":true,"json":true,"nmea":true};\n'
"""What to say first."""
#: Longer than any line that gpsd writes (GPS_JSON_RESPONSE_MAX).
_LONGEST_LINE = 1 << 16
#: What gpsd's own sentences for a binary receiver are good for: the satellites.
_SATELLITES = (b"GSA", b"GSV")


class GpsdProtocol:
    """One connection."""

    def __init__(self) -> None:
        self.devices: dict[str, str] = {}
        """The driver of each receiver that gpsd has, by path."""
        self._line = b""
        self._native: set[str] = set()
        self._sky: dict[str, Any] = {}
        self._is_gpsd = False

    def feed(self, data: bytes) -> bytes:
        """Return the sentences in the next bytes.

        Raises:
            MalformedInput: Who speaks is no gpsd: it does not begin with its version, or lines do not end.
        """
        *lines, self._line = (self._line + data).split(b"\n")
        found = b"".join(self._taken(line) for line in lines)
        if len(self._line) > _LONGEST_LINE:
            raise MalformedInput("gpsd's lines are shorter.")
        return found

    def _taken(self, line: bytes) -> bytes:
        if line.startswith(b"{"):
            return self._take_notice(line)
        if not self._is_gpsd:
            raise MalformedInput("gpsd begins with its version.")
        return line + b"\n" if not self._native or line[3:6] in _SATELLITES else b""

    def _take_notice(self, line: bytes) -> bytes:
        """Learn which receivers there are; return what a binary one has said, as sentences."""
        try:
            notice = json.loads(line)
        except (ValueError, RecursionError):
            return b""
        match notice:
            case {"class": "VERSION"}:
                self._is_gpsd = True
            case {"class": "DEVICES", "devices": list(devices)}:
                self.devices, self._native = {}, set()
                for device in devices:
                    self._take_device(device)
            case {"class": "DEVICE"}:
                self._take_device(notice)
            case {"class": "SKY"}:
                self._sky = notice
            case {"class": "TPV"} if self._native:
                return sentences(notice, self._sky)
            case _:
                pass
        return b""

    def _take_device(self, device: Any) -> None:
        """Note a receiver that came, or forget one that went: gpsd says that it was activated at no time."""
        if not isinstance(device, dict) or not isinstance(device.get("path"), str):
            return
        path = device["path"]
        self.devices.pop(path, None)
        self._native.discard(path)
        if device.get("activated") != 0:
            self.devices[path] = str(device.get("driver") or "")[:40]
            if device.get("native") == 1:
                self._native.add(path)
