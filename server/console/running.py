"""The console at work: what the watcher hears, drawn ten times a second, and what operators press, done."""

import asyncio
from concurrent.futures import TimeoutError as FutureTimeout
from pathlib import Path
from time import monotonic
from typing import Any, Final

from assets.records import Site
from server.console import saving
from server.console.desk import Desk
from server.console.eyes import Eyes, go_to
from server.console.model import build_parts
from server.console.scene import Layers, Scene
from server.console.watching import Watcher
from server.messages import ControlReply

_DRAW_EVERY_S: Final = 0.1
#: The panel, and pictures through a walker's eyes, take turns of the drawing.
_PANEL_EVERY: Final = 5
_EYES_EVERY: Final = 2
_ANSWER_S: Final = 65.0
_TODAY: Final = "occluders.glb"
"""The one built model that is not packed: viser cannot unpack."""


class Running:
    """One console. viser's callbacks come on threads of its own; everything else happens on one event loop."""

    def __init__(self, server: Any, site: Site, url: str, token: str | None, trust: str | None) -> None:
        """`server` is a `viser.ViserServer`; for the rest see `Watcher`."""
        self._server, self._site = server, site
        self._watcher = Watcher(url, token, trust)
        self._layers = Layers()
        self._scene, self._eyes = Scene(server, self._layers), Eyes()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._desk = Desk(server, self._layers, self)
        server.on_client_disconnect(lambda client: self._soon(self._forget, client))

    async def run(self) -> None:
        """Watch and draw until cancelled."""
        self._loop = asyncio.get_running_loop()
        watching = asyncio.create_task(self._watcher.run())
        building = asyncio.create_task(self._add_model())
        try:
            turn, drawn = 0, set[str]()
            while True:
                drawn = await self._draw(turn, drawn)
                turn += 1
                await asyncio.sleep(_DRAW_EVERY_S)
        finally:
            watching.cancel()
            building.cancel()
            await asyncio.gather(watching, building, return_exceptions=True)

    async def _add_model(self) -> None:
        parts = await asyncio.to_thread(build_parts, self._site)
        today = Path(self._site.folder) / "built" / _TODAY
        self._scene.add_model(parts, today.read_bytes() if today.is_file() else None)

    async def _draw(self, turn: int, drawn: set[str]) -> set[str]:
        walks = {walk.name: walk for walk in self._watcher.walks}
        for name in drawn - set(walks):
            self._scene.remove(name)
        for walk in walks.values():
            self._scene.draw(walk, monotonic())
        if turn % _EYES_EVERY == 0:
            self._eyes.show(walks)
        if turn % _PANEL_EVERY == 0:
            self._desk.show(list(walks.values()))
        for walk in walks.values():
            await self._watcher.acknowledge(walk)
        return set(walks)

    # -- what operators press, on viser's threads ---------------------------------------------------------------------

    def ask(self, name: str, action: str, value: object = None) -> ControlReply:
        """Ask a walk's rig for something and wait for what it answers."""
        if self._loop is None:
            return ControlReply("", ok=False, error="The console is about to begin: try again.")
        try:
            return asyncio.run_coroutine_threadsafe(self._watcher.ask(name, action, value), self._loop).result(
                _ANSWER_S
            )
        except FutureTimeout:
            return ControlReply("", ok=False, error="The walk does not answer: try again.")

    def layers_changed(self) -> None:
        """Draw the layers as they are now."""
        self._soon(self._show_layers)

    def look_through(self, client: Any, name: str | None) -> bool:
        """Show a client the square through a walker's eyes, or no longer."""
        looks = self._eyes.toggle(client, name)
        self.layers_changed()
        return looks

    def go_to(self, client: Any, name: str) -> None:
        """Bring a client near a walker."""
        walk = self._watcher.get(name)
        if walk is not None:
            go_to(client, walk)

    def save(self, what: str, client: Any, name: str) -> None:
        """Send a client what it wants to keep."""
        walk = self._watcher.get(name)
        try:
            match what:
                case "picture":
                    client.send_file_download(f"{name}.png", saving.picture(client))
                case "page":
                    client.send_file_download(f"{name}.html", self._server.scene.as_html(dark_mode=True).encode())
                case "table" if walk is not None:
                    client.send_file_download(f"{name}.csv", saving.table(walk))
        except TimeoutError:
            client.add_notification("No picture", "The browser did not draw it in time: try again.", color="orange")

    def _forget(self, client: Any) -> None:
        self._eyes.forget(client)
        self._show_layers()

    def _show_layers(self) -> None:
        self._scene.show_layers(self._eyes.names)

    def _soon(self, do: Any, *arguments: Any) -> None:
        if self._loop is not None:
            self._loop.call_soon_threadsafe(do, *arguments)
