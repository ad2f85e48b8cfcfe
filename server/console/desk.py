"""The panel of the console: which walk, what is drawn, charts, the replay and its filter, and what can be saved. viser alone.

viser calls back on threads of its own: what a callback wants of walks goes through `Deeds`.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, Final, Protocol

import numpy as np

from server.console.charts import Charts
from server.console.scene import Layers
from server.console.settings_tab import SettingsTab
from server.console.status import NOBODY, status_of
from server.console.walk import Walk
from server.messages import ControlReply

_SPEEDS: Final = ("0.5", "1", "2", "4", "8")
_NO_WALK: Final = "nobody"
_LEGEND: Final = (
    "Blue is attested: it stands, or was excavated. Magenta is inferred from its plan, its fragments or buildings like it. "
    "Yellow is hypothetical: one way it may have been."
)
_EYES: Final = "Through the walker's eyes"
_LEAVE: Final = "Back to the square"


class Deeds(Protocol):
    """What the panel can have done. Its methods may be called from any thread."""

    def ask(self, name: str, action: str, value: object = None) -> ControlReply:
        """Ask a walk's rig for something and wait for what it answers."""
        ...

    def layers_changed(self) -> None:
        """Have the layers drawn as they are now."""
        ...

    def look_through(self, client: Any, name: str | None) -> bool:
        """Show a client the square through a walker's eyes, or with None no longer; return whether it now does."""
        ...

    def go_to(self, client: Any, name: str) -> None:
        """Bring a client near a walker."""
        ...

    def save(self, what: str, client: Any, name: str) -> None:
        """Send a client a `picture`, a `page` or a `table` as a file."""
        ...


class Desk:
    """The panel, which all operators see and use in common."""

    def __init__(self, server: Any, layers: Layers, deeds: Deeds) -> None:
        """`server` is a `viser.ViserServer`."""
        self._gui, self._layers, self._deeds = server.gui, layers, deeds
        self._walks: list[Walk] = []
        self._options: tuple[str, ...] = ()
        self._gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False, brand_color=(226, 138, 74))
        self._gui.set_panel_label("Agora")
        self._gui.main_panel.dock_right()
        self._gui.main_panel.set_width(380)
        self._choice = self._gui.add_dropdown("Walk", (_NO_WALK,))
        tabs = self._gui.add_tab_group()
        with tabs.add_tab("Walk"):
            self._build_walk()
        with tabs.add_tab("Charts"):
            self._charts = Charts(self._gui)
        with tabs.add_tab("Filter"):
            self._settings = SettingsTab(self._gui, self._ask)
        with tabs.add_tab("View"):
            self._build_layers()
        with tabs.add_tab("Save"):
            self._build_saving()

    @property
    def chosen(self) -> Walk | None:
        """The walk that the panel is about."""
        value = self._choice.value
        return next((walk for walk in self._walks if walk.name == value), None)

    def show(self, walks: list[Walk]) -> None:
        """Show how walks are now. To be called once or twice a second."""
        self._walks = walks
        options = tuple(walk.name for walk in walks) or (_NO_WALK,)
        if options != self._options:
            kept = self._choice.value
            self._options = self._choice.options = options
            self._choice.value = kept if kept in options else options[0]
        walk = self.chosen
        _set(self._status, "content", NOBODY if walk is None else status_of(walk))
        self._show_replay(walk)
        if walk is not None:
            self._charts.show(walk)
            self._settings.show(walk)

    # -- tabs ---------------------------------------------------------------------------------------------------------

    def _build_walk(self) -> None:
        self._status = self._gui.add_markdown(NOBODY)
        self._button(
            _EYES, self._look_through, hint="The camera's picture with the square over it, at most five a second."
        )
        self._button("Go to the walker", lambda client, name: self._deeds.go_to(client, name))
        self._replay = self._gui.add_folder("Replay", visible=False)
        with self._replay:
            self._place = self._gui.add_progress_bar(0.0)
            self._play = self._button("Pause", self._play_or_pause)
            self._go = self._gui.add_slider("Go to, s", min=0.0, max=1.0, step=0.1, initial_value=0.0)
            self._button("Go there", lambda client, name: self._ask(client, name, "seek", float(self._go.value)))
            self._speed = self._gui.add_dropdown("Speed", _SPEEDS, initial_value="1")
            self._speed.on_update(lambda event: self._of_client(event, self._change_speed))
            self._estimator = self._gui.add_dropdown("Estimator", ("-",))
            self._estimator.on_update(lambda event: self._of_client(event, self._change_estimator))

    def _show_replay(self, walk: Walk | None) -> None:
        playback = None if walk is None or not walk.is_replay else walk.session.get("playback")
        _set(self._replay, "visible", playback is not None)
        if walk is None or playback is None:
            return
        duration_s = max(0.1, float(walk.session["duration_s"]))
        _set(self._place, "value", round(min(100.0, 100.0 * playback_s(walk) / duration_s), 1))
        _set(self._go, "max", round(duration_s, 1))
        _set(self._play, "label", "Pause" if playback["playing"] else "Play")
        runnable = tuple(n for n in walk.session["estimators"] if n not in walk.session["unavailable"])
        if self._estimator.options != runnable and walk.session["estimator"] in runnable:
            self._estimator.options = runnable
        if walk.session["estimator"] in self._estimator.options:
            _set(self._estimator, "value", walk.session["estimator"])

    def _build_layers(self) -> None:
        layers = self._layers
        for label, name in (
            ("The ancient square", "buildings"),
            ("Land and plants", "land"),
            ("What stands today", "today"),
            ("Paths by motion model", "paths"),
            ("Ellipsoids: 95 % of the error", "ellipsoids"),
            ("Pictures", "pictures"),
            ("Colour by evidence", "evidence"),
        ):
            box = self._gui.add_checkbox(label, getattr(layers, name))
            box.on_update(lambda event, name=name: self._change_layer(name, bool(event.target.value)))
        opacity = self._gui.add_slider("Opacity", min=0.1, max=1.0, step=0.05, initial_value=1.0)
        opacity.on_update(lambda event: self._change_layer("opacity", float(event.target.value)))
        self._legend = self._gui.add_markdown(_LEGEND, visible=False)

    def _build_saving(self) -> None:
        for label, what, hint in (
            ("Picture of this view", "picture", "PNG"),
            ("Scene as a page", "page", "One HTML file that opens without a server"),
            ("Path as a table", "table", "CSV: time, place, how sure, motion model"),
        ):
            self._button(label, partial(self._deeds.save, what), hint=hint)

    # -- what the buttons do ------------------------------------------------------------------------------------------

    def _button(self, label: str, do: Callable[[Any, str], object], hint: str | None = None) -> Any:
        button = self._gui.add_button(label, hint=hint, color=None if label == _EYES else "gray")
        button.on_click(lambda event: self._of_client(event, do))
        return button

    def _of_client(self, event: Any, do: Callable[[Any, str], object]) -> None:
        """Do something about the chosen walk, if an operator's own hand was it."""
        walk = self.chosen
        if event.client is not None and walk is not None:
            do(event.client, walk.name)

    def _look_through(self, client: Any, name: str) -> None:
        looks = self._deeds.look_through(client, name)
        client.add_notification(
            _EYES if looks else _LEAVE,
            "Press the button once more to leave." if looks else "You have left the walker's eyes.",
            auto_close_seconds=4.0,
        )

    def _play_or_pause(self, client: Any, name: str) -> None:
        self._ask(client, name, "pause" if self._play.label == "Pause" else "play")

    def _change_speed(self, client: Any, name: str) -> None:
        self._ask(client, name, "speed", float(self._speed.value))

    def _change_estimator(self, client: Any, name: str) -> None:
        walk = self.chosen
        if walk is not None and self._estimator.value != walk.session.get("estimator"):
            self._ask(client, name, "estimator", self._estimator.value)

    def _change_layer(self, name: str, value: bool | float) -> None:
        setattr(self._layers, name, value)
        self._legend.visible = self._layers.evidence
        self._deeds.layers_changed()

    def _ask(self, client: Any, name: str, action: str, value: object = None) -> bool:
        reply = self._deeds.ask(name, action, value)
        if not reply.ok:
            client.add_notification("That did not work", reply.error or "The walk gave no reason.", color="orange")
        return reply.ok


def playback_s(walk: Walk) -> float:
    """Return where a replay stands, seconds from its start."""
    frame = walk.frame
    return float(walk.session["playback"]["position_s"] if frame is None else frame.position_s)


def _set(handle: Any, name: str, value: Any) -> None:
    """Set what a handle shows, and send nothing where that is what it shows already."""
    if not np.array_equal(getattr(handle, name), value):
        setattr(handle, name, value)
