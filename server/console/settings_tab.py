"""Settings of a replay's estimator, changed while it runs: a tab of viser's panel."""

from collections.abc import Callable
from typing import Any, Final

from server.console.status import plain
from server.console.walk import Walk
from server.settings import Setting, all_settings

_LIVE: Final = "*Settings can be changed on a replay: a live walk keeps those that it began with.*"
_PROMISE: Final = "*The walk is worked out anew with each change, and stays where it is. All who watch it see that.*"

Ask = Callable[[Any, str, str, object], bool]
"""Asks a walk's rig on a client's behalf: client, walk, action, value; returns whether it was done."""


class SettingsTab:
    """The tab."""

    def __init__(self, gui: Any, ask: Ask) -> None:
        """Build it in the container that is open."""
        self._ask = ask
        self._walk: Walk | None = None
        self._family = ""
        self._chosen: dict[str, str] = {}
        """What was changed here, by key, of the walk and estimator that are shown."""
        self._about: tuple[str, str] = ("", "")
        self._head = gui.add_markdown(_LIVE)
        self._form = gui.add_folder("Setting", visible=False)
        with self._form:
            self._key = gui.add_dropdown("Name", ("-",))
            self._meaning = gui.add_markdown("")
            self._value = gui.add_text("Value", "")
            apply, reset = gui.add_button("Apply"), gui.add_button("All as usual", color="gray")
            self._list = gui.add_markdown("")
        self._key.on_update(lambda event: self._show_setting())
        apply.on_click(lambda event: self._apply(event.client))
        reset.on_click(lambda event: self._reset(event.client))

    def show(self, walk: Walk) -> None:
        """Show the settings that a walk's estimator has."""
        self._walk = walk
        is_open = walk.is_replay and walk.session.get("estimator", "truth") != "truth"
        if self._form.visible != is_open:
            self._form.visible, self._head.content = is_open, _PROMISE if is_open else _LIVE
        estimator = str(walk.session.get("estimator", ""))
        if not is_open or self._about == (walk.name, estimator):
            return
        if self._about[0] != walk.name:
            self._chosen = {}
        self._about = (walk.name, estimator)
        family = "precise." if estimator.endswith("precise") else "paper."
        if family != self._family:
            self._family = family
            self._key.options = tuple(s.key.removeprefix(family) for s in all_settings() if s.key.startswith(family))
        self._show_setting()

    @property
    def _setting(self) -> Setting | None:
        key = self._family + self._key.value
        return next((setting for setting in all_settings() if setting.key == key), None)

    def _show_setting(self) -> None:
        setting = self._setting
        if setting is not None:
            self._meaning.content = f"{plain(setting.meaning)}\n\nUsual: {plain(setting.text)}"
            self._value.value = self._chosen.get(setting.key, setting.text)
        rows = [f"{plain(key.removeprefix(self._family))} = {plain(value)}" for key, value in self._chosen.items()]
        self._list.content = "\n\n".join(["**Changed**", *rows]) if rows else ""

    def _apply(self, client: Any) -> None:
        setting, walk, value = self._setting, self._walk, self._value.value.strip()
        if setting is None or walk is None or client is None:
            return
        if self._ask(client, walk.name, "settings", f"{setting.key}={value}"):
            self._chosen[setting.key] = value
        self._show_setting()

    def _reset(self, client: Any) -> None:
        if self._walk is not None and client is not None and self._ask(client, self._walk.name, "settings", ""):
            self._chosen = {}
        self._show_setting()
