"""The AR page seen from a test: what it says of itself, what it sends, what it has drawn."""

import base64
import json
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Browser, Page, WebSocket

Pixels = NDArray[np.uint8]
PATIENCE_S = 60.0
"""For a machine that does other things as well; nothing here is timed."""
SIZE_PX = (640, 480)

ALONE = """() => {
    for (const panel of document.querySelectorAll("header, footer, aside, .panel")) panel.style.visibility = "hidden";
}"""
"""Hides what stands over the picture."""
_READ = """([width, height]) => {
    const bytes = agora.readPixels(0, 0, width, height);
    let text = "";
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text);
}"""

_GO = """view => new Promise(resolve => {
    const hash = `#${view}`;
    if (location.hash === hash) return resolve();
    addEventListener("hashchange", () => resolve(), { once: true });
    location.hash = hash;
})"""


class ArPage:
    """One AR page and a record of its messages."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.requests: list[str] = []
        """Every address asked for, WebSockets included."""
        self.sent: list[dict[str, Any]] = []
        self.received: list[dict[str, Any]] = []
        """Text messages, in order."""
        self.errors: list[str] = []
        """What the page's scripts did not catch, or the browser refused."""
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("websocket", self._listen)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", lambda m: self.errors.append(m.text) if m.type == "error" else None)

    def _listen(self, socket: WebSocket) -> None:
        self.requests.append(socket.url)
        socket.on("framesent", lambda data: self.sent.append(json.loads(data)))
        socket.on(
            "framereceived", lambda data: self.received.append(json.loads(data)) if isinstance(data, str) else None
        )

    def forget(self) -> None:
        """Empty the record."""
        for record in (self.requests, self.sent, self.received, self.errors):
            record.clear()

    def ask(self, expression: str, argument: Any = None) -> Any:
        """Return the value of a JavaScript expression or function."""
        return self.page.evaluate(expression, argument)

    def until(self, expression: str) -> None:
        """Wait until a JavaScript expression holds. (Playwright's own wait needs `eval`, which our pages do not allow.)"""
        deadline = monotonic() + PATIENCE_S
        while not self.ask(expression):
            assert monotonic() < deadline, f"waited in vain for {expression}; the page is at {self.state()}"
            self.page.wait_for_timeout(20)

    def go(self, view: str) -> None:
        """On the start page: take what stands behind the `#` of an address, and wait until it is drawn as finely as it can be."""
        self.ask(_GO, view)
        self.settle()

    def settle(self) -> None:
        """On the start page: wait until all that was asked for is drawn."""
        self.ask("agora.ready")
        self.until("agora.stats()?.whole")

    def until_drawn(self) -> None:
        """Wait for the first picture, the model and the session's state."""
        self.until("globalThis.agora?.stats() != null && agora.stats().framesDrawn > 0 && agora.session() !== null")
        self.ask("agora.ready")

    def state(self) -> Any:
        """Return what the page knows, for a failing test to print."""
        return self.ask("[globalThis.agora?.stats(), globalThis.agora?.session?.(), document.body?.innerText]")

    def stats(self) -> dict[str, Any]:
        """Return `agora.stats()`."""
        stats: dict[str, Any] = self.ask("agora.stats()")
        return stats

    def replied(self, action: str, count: int = 1) -> dict[str, Any]:
        """Wait for the reply to the page's `count`-th request of a kind and return it."""
        deadline = monotonic() + PATIENCE_S
        while True:
            asked = [m for m in self.sent if m["type"] == "control" and m["action"] == action]
            answers = {m["request_id"]: m for m in self.received if m["type"] == "reply"}
            if len(asked) >= count and asked[count - 1]["request_id"] in answers:
                return answers[asked[count - 1]["request_id"]]
            assert monotonic() < deadline, f"no reply to {action}: sent {self.sent[-5:]}, received {self.received[-5:]}"
            self.page.wait_for_timeout(20)

    def pause(self) -> None:
        """Pause by the button; pictures that are under way may still be drawn."""
        self.until("agora.session().playback.playing")
        self.page.click("#play")
        self.until("!agora.session().playback.playing")

    def seek(self, position_s: float) -> None:
        """Move the slider, as a drag that ends there does."""
        before = len([m for m in self.sent if m.get("action") == "seek"])
        self.page.locator("#seek").fill(str(position_s))
        assert self.replied("seek", before + 1)["ok"]

    def seek_to(self, position_s: float, frame_id: int) -> None:
        """Move the slider, seen or not, and wait for the picture of that place."""
        move = """(position) => {
            const seek = document.querySelector("#seek");
            [seek.value, seek.step] = [position, "any"];
            seek.value = position;
            seek.onchange();
        }"""
        self.ask(move, position_s)
        self.until(f"agora.stats().lastFrameId === {frame_id}")

    def acknowledged(self, frame_id: int) -> bool:
        """Whether the page has told the server that it is done with a picture."""
        return {"type": "ack", "frame_id": frame_id} in self.sent

    def until_acknowledged(self, frame_id: int) -> None:
        """Wait for that."""
        deadline = monotonic() + PATIENCE_S
        while not self.acknowledged(frame_id):
            assert monotonic() < deadline, f"picture {frame_id} was not acknowledged; sent {self.sent[-5:]}"
            self.page.wait_for_timeout(20)

    def pixels(self, size_px: tuple[int, int] = SIZE_PX) -> Pixels:
        """Return the composite in pixels of the stored picture, (height, width, 3), red first."""
        width, height = size_px
        raw = np.frombuffer(base64.b64decode(self.ask(_READ, list(size_px))), np.uint8)
        return np.ascontiguousarray(raw.reshape(height, width, 4)[..., :3])


@contextmanager
def open_page(browser: Browser, **options: Any) -> Iterator[ArPage]:
    """Open an empty page of 640 x 480 pixels."""
    width, height = SIZE_PX
    context = browser.new_context(viewport={"width": width, "height": height}, **options)
    try:
        yield ArPage(context.new_page())
    finally:
        context.close()
