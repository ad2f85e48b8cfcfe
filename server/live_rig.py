"""A rig with live sensors: sources, tracker and recording joined to a server, or to none. The live brother of `replay`."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic_ns, time_ns
from typing import Any

import numpy as np

from server.aligning import Aligner
from server.figures import FigureTeller
from server.messages import ControlReply, ControlRequest
from server.placing import Placing
from server.presenting import Presenter
from server.push import RigLink
from server.replay import UNCALIBRATED
from server.standing import FAR_M, distance_m
from tracker.assembly import assemble
from tracker.blank import CAMERA
from tracker.errors import InputError, MalformedInput, MissingSensor
from tracker.estimator import Pose
from tracker.estimators import check_name, missing_sensors
from tracker.lens import scaled
from tracker.measurements import Frame, GpsFix, Measurement
from tracker.pipeline import Pipeline
from tracker.playback import Shown
from tracker.precise.memory import to_toml
from tracker.retractable import Retractable
from tracker.rig import CameraModel, Rig, guessed_camera
from tracker.rig_memory import load_memory, save_memory
from tracker.running.core import WalkCore
from tracker.running.health import SensorState
from tracker.running.recorder import Recorder, as_read, recorded
from tracker.running.walk import LiveWalk, WalkState
from tracker.said import refusal_words
from tracker.sources.source import Source
from tracker.truth import TruthEstimator

#: Health is sent when a sensor's state changes, and else this often.
_HEALTH_NS = 1_000_000_000
#: Fusion takes what is said within milliseconds, unless it has just begun anew.
_ANSWER_S = 5.0
#: The best first.
_PREFERENCE = ("camera-gps-imu/precise", "gps-imu/precise")


@dataclass(frozen=True)
class _Sensors:
    """What a rig has, as `missing_sensors` asks."""

    counts: dict[str, int]
    has_truth: bool = False


class LiveRig:
    """One walk with live sensors; `start` starts it and `close` ends it."""

    def __init__(
        self,
        sources: Sequence[Source],
        rig: Rig,
        placing: Placing,
        *,
        correct: Callable[[Measurement], Measurement] = lambda measurement: measurement,
        estimator: str | None = None,
        tracks: bool = True,
        record: Path | None = None,
        about: Mapping[str, str] | None = None,
        rig_file: Path | None = None,
    ) -> None:
        """Prepare a walk; the recording's file is opened, and nothing else runs.

        Args:
            sources: At most one each of `gps`, `imu` and `camera`.
            rig: Where its sensors sit, and its camera's lens, where it is known.
            placing: The site.
            correct: What a calibration makes of a measurement.
            estimator: None for the best that the sensors allow.
            tracks: Whether there is an estimator at all; a rig that only records has none.
            record: The file to write; None for none.
            about: What goes to the recording's head.
            rig_file: Beside it is kept what the rig learns of itself; None to keep nothing.

        Raises:
            MissingSensor: No estimator can run with these sensors, or not the one that was asked for.
            InputError: The recording cannot be written.
        """
        names = [source.name for source in sources]
        self._placing = placing
        self._aligner = Aligner(placing)
        self._has_camera = "camera" in names
        self._recorded_rig = recorded(rig if self._has_camera else replace(rig, camera=None))
        # what is measured by must be, to the last bit, what a replay of the recording will measure by
        self._rig = as_read(self._recorded_rig)
        self.estimator = _choose(estimator, names, self._rig) if tracks else ""
        self._utc_start_ns, self._t_start_ns = time_ns(), monotonic_ns()
        self._rig_file = rig_file if placing.anchor == "site" else None  # elsewhere nobody knows the receiver's error
        self._memory = None if self._rig_file is None else load_memory(self._rig_file, self._utc_offset_ns)
        self._recorder = None if record is None else self._record(record, dict(about or {}))
        self._first_fix: GpsFix | None = None
        self._core = WalkCore(
            self._make_pipeline,
            self._rig,
            dict.fromkeys(names, self._t_start_ns),
            waits_for_fix=placing.anchor == "here" and "gps" in names,
            correct=correct,
            record=self._take,
        )
        self._walk = LiveWalk(self._core, sources, show=self._show, show_pose=self._show_pose, recorder=self._recorder)
        self._link: RigLink | None = None
        self._figures = FigureTeller(self._send_text, self._t_start_ns, monotonic_ns)
        self._presenter: Presenter | None = None
        self._misfit: str | None = None
        self._told: tuple[SensorState, ...] = ()
        self._health_due_ns = 0

    def _record(self, path: Path, about: dict[str, str]) -> Recorder:
        about["estimator"] = self.estimator
        about["memory"] = "" if self._memory is None else to_toml(self._memory)
        return Recorder(
            path, self._recorded_rig, t_start_ns=self._t_start_ns, utc_start_ns=self._utc_start_ns, about=about
        )

    def _make_pipeline(self, first_fix: GpsFix | None) -> Pipeline:
        if not self.estimator:
            return Pipeline(TruthEstimator(np.eye(4)))  # ignores everything: the recording is all that is wanted
        pipeline = assemble(
            self.estimator,
            origin=self._placing.origin(first_fix),
            rig=self._rig,
            date_ns=self._utc_start_ns,
            eyes_z_m=self._placing.eyes_for(self.estimator),
            memory=self._memory,
        )
        return self._placing.levelled(pipeline)

    def _take(self, measurement: Measurement) -> None:
        """Take what the estimator is fed, on fusion's thread."""
        if self._recorder is not None:
            self._recorder.put(measurement)
        if self._first_fix is None and isinstance(measurement, GpsFix) and measurement.valid:
            self._first_fix = measurement

    def start(self, rig_url: str | None = None, token: str = "") -> None:
        """Start tracking, and connecting where there is a server; the one does not wait for the other."""
        if rig_url is not None:
            self._link = RigLink(rig_url, token, self._control)
            self._link.send_state(self._description())
        self._walk.start()

    def close(self) -> None:
        """End every thread and close the recording."""
        self._walk.close()
        self._remember()
        if self._link is not None:
            self._link.close()

    @property
    def _utc_offset_ns(self) -> int:
        """UTC less the walk's clock."""
        return self._utc_start_ns - self._t_start_ns

    def _remember(self) -> None:
        """Keep what was learned for the next walk; fusion has ended."""
        pipeline = self._core.pipeline
        if self._rig_file is None or pipeline is None or not isinstance(pipeline.estimator, Retractable):
            return
        memory = pipeline.estimator.memory()
        if memory is not None:
            save_memory(self._rig_file, memory, self._utc_offset_ns)

    @property
    def state(self) -> WalkState:
        """How the walk is now."""
        return self._walk.state

    @property
    def link(self) -> RigLink | None:
        """The link to the server, if there is one."""
        return self._link

    @property
    def error(self) -> BaseException | None:
        """What ended the tracker, if anything did. (A server that will not have us ends nothing.)"""
        return self._walk.error

    # -- to the server, on the thread that shows ----------------------------------------------------------------------

    def _description(self) -> dict[str, object]:
        return {
            "kind": "live",
            "log": None,
            "estimator": self.estimator,
            "estimators": [self.estimator],
            "unavailable": {},
            "anchor": self._placing.anchor,
            "utc_offset_s": self._utc_offset_ns * 1e-9,
            "playback": None,
            "notice": self._notice(None),
            "health": {},
        }

    def _notice(self, state: WalkState | None) -> str | None:
        """Return what a viewer should know besides the sensors' health, most important first."""
        if state is not None and state.recorder is not None and state.recorder.warning:
            return state.recorder.warning
        fix, origin = self._first_fix, self._placing.site_origin
        if self._placing.anchor == "site" and fix is not None and (away_m := distance_m(fix, origin)) > FAR_M:
            return f"This rig is {away_m / 1000.0:,.0f} km from the site: start it with --anchor here."
        if self._misfit is not None:
            return self._misfit
        if not self._has_camera:
            return "This rig has no camera: the square is drawn over an empty picture."
        if self._rig.camera is None:
            return UNCALIBRATED
        return None

    def _show(self, shown: Shown) -> None:
        self._tell_health()
        if self._link is None:
            return
        presenter = self._presenter or self._make_presenter(shown.frame)
        if presenter is not None:
            pose = self._placing.placed(shown.pose, self.estimator)
            self._aligner.note(shown.frame, pose)
            position_s = max(0.0, (shown.frame.t_ns - self._t_start_ns) * 1e-9)
            presenter.show(shown, pose, estimator=self.estimator, position_s=position_s)

    def _show_pose(self, pose: Pose | None) -> None:
        self._tell_health()
        placed = self._placing.placed(pose, self.estimator)
        if self._presenter is not None and placed is not None:
            self._presenter.show_pose(placed, self.estimator)

    def _make_presenter(self, first: Frame) -> Presenter | None:
        """Return what sends pictures, once the first one has shown how large they are."""
        assert self._link is not None
        try:
            height_px, width_px = first.picture.gray().shape
        except MalformedInput:
            return None
        self._presenter = Presenter(self._link, replace(self._rig, camera=self._lens(width_px, height_px)))
        return self._presenter

    def _lens(self, width_px: int, height_px: int) -> CameraModel:
        """Return the lens for pictures of a size: as calibrated, scaled, or guessed."""
        camera = self._rig.camera if self._has_camera else CAMERA
        if camera is None:
            return guessed_camera(width_px, height_px)
        if (camera.width_px, camera.height_px) == (width_px, height_px):
            return camera
        if abs(camera.width_px * height_px - camera.height_px * width_px) > 0.01 * camera.width_px * height_px:
            self._misfit = (
                f"The camera gives {width_px}x{height_px} pixels and was calibrated at {camera.width_px}x{camera.height_px}: "
                "calibrate it anew, the square does not fit."
            )
        return scaled(camera, width_px, height_px)

    def _control(self, request: ControlRequest) -> ControlReply:
        """Take a viewer's request, on the link's thread."""
        if request.action == "figures":
            self._figures.ask()
            return ControlReply(request.request_id, ok=True)
        if request.action != "align":
            error = "This walk is live: it cannot be paused, sought or changed."
            return ControlReply(request.request_id, ok=False, error=error)
        presenter = self._presenter
        if presenter is None:
            return ControlReply(request.request_id, ok=False, error="There is no picture yet: wait for the first one.")
        try:
            outcome = self._walk.say(self._aligner.said(request, presenter.camera)).result(_ANSWER_S)
        except InputError as error:
            return ControlReply(request.request_id, ok=False, error=str(error))
        except (CancelledError, TimeoutError):
            return ControlReply(request.request_id, ok=False, error="The tracker does not answer: try again.")
        refused = refusal_words(outcome, self.estimator)
        return ControlReply(request.request_id, ok=refused is None, error=refused)

    def _tell_health(self) -> None:
        if self._link is None:
            return
        state = self._walk.state
        self._figures.look(self._walk.innovations(), state.rejected)
        states = tuple(health.state for health in state.sensors.values())
        if states == self._told and state.t_ns < self._health_due_ns:
            return
        self._told, self._health_due_ns = states, state.t_ns + _HEALTH_NS
        self._link.send_state({"health": health_of(state), "notice": self._notice(state)})

    def _send_text(self, text: str) -> None:
        if self._link is not None:
            self._link.send_text(text)


def health_of(state: WalkState) -> dict[str, Any]:
    """Return how the sensors are, for whoever watches."""
    return {
        name: {
            "state": health.state.value,
            "trouble": health.state.is_trouble,
            "sentence": health.sentence,
            "rate_hz": round(health.rate_hz, 1),
        }
        for name, health in state.sensors.items()
    }


def _choose(estimator: str | None, names: Sequence[str], rig: Rig) -> str:
    counts = {"imu": "imu", "gps": "gps", "frames": "camera"}
    sensors = _Sensors({count: int(name in names) for count, name in counts.items()})
    if estimator is not None:
        check_name(estimator)
        candidates: tuple[str, ...] = (estimator,)
    else:
        candidates = _PREFERENCE
    missing = {name: missing_sensors(name, sensors, rig) for name in candidates}
    best = next((name for name, reason in missing.items() if reason is None), None)
    if best is None:
        name, reason = next(reversed(missing.items()))
        raise MissingSensor(f"This rig cannot run {name}: it has {reason}; see --imu, --gps and --camera.")
    return best
