"""Somebody between the server and the page who changes messages."""

from playwright.sync_api import Page, WebSocketRoute

from server.wire import is_frame


class Tampering:
    """Between the server and the page: patches every second frame message, and notes whose."""

    def __init__(self, page: Page, offset: int, patch: bytes, every: int = 2) -> None:
        self.patched: list[int] = []
        self.whole: list[int] = []
        self.patch = patch
        self._offset, self._every = offset, every
        page.route_web_socket("**/ws/view/**", self._join)

    def _join(self, route: WebSocketRoute) -> None:
        server = route.connect_to_server()
        server.on_message(lambda message: route.send(self._pass(message)))

    def _pass(self, message: str | bytes) -> str | bytes:
        if isinstance(message, str) or not is_frame(message):
            return message
        frame_id = int.from_bytes(message[8:12], "little")
        if (len(self.patched) + len(self.whole)) % self._every != self._every - 1:
            self.whole.append(frame_id)
            return message
        self.patched.append(frame_id)
        end = self._offset + len(self.patch)
        return message[: self._offset] + self.patch + message[end:]
