"""A recorded walk pushed to the server as a rig would push it: log, estimator, threads and link joined."""

from concurrent.futures import CancelledError
from dataclasses import dataclass, replace

from server.aligning import Aligner
from server.console import Console
from server.messages import ControlReply, ControlRequest
from server.placing import Anchor, Height, Placing
from server.presenting import Presenter
from server.push import RigLink
from server.standing import FAR_M, distance_m
from tracker.blank import CAMERA, BlankCamera
from tracker.errors import InputError, MalformedInput
from tracker.estimator import Origin
from tracker.estimators import DEFAULT_ESTIMATOR, ESTIMATORS, missing_sensors
from tracker.evaluate import make_pipeline
from tracker.grounding import GroundHeight
from tracker.log import Log
from tracker.measurements import Frame
from tracker.pipeline import Pipeline
from tracker.playback import Playback, Recording, Shown
from tracker.precise.ground import EyeHeight
from tracker.rig import Rig, guessed_camera
from tracker.runner import Player, PlayerState, ReadAhead, VisionThread
from tracker.upright import Upright

#: Said of a camera whose lens is guessed.
UNCALIBRATED = "This camera was never calibrated: a lens 60 degrees wide is assumed, so the square may not fit."
#: The best first: what plays when nothing was chosen.
PREFERENCE = (DEFAULT_ESTIMATOR, "gps-imu/precise", "truth")


@dataclass(frozen=True)
class ReplaySettings:
    """How a log is shown."""

    estimator: str | None = None
    """None for the best that the log's sensors allow."""
    anchor: Anchor = "site"
    height: Height = "ground"
    looping: bool = False
    look_again: bool = False
    """Look at the pictures anew where the log holds what the live front end had made of them."""


class Replay:
    """One log being played to one session."""

    def __init__(
        self,
        log: Log,
        settings: ReplaySettings,
        *,
        site_origin: Origin,
        ground_z_m: GroundHeight,
        eyes_z_m: EyeHeight,
        eye_height_m: float,
        console: Console | None = None,
    ) -> None:
        """Prepare a replay; `start` starts it.

        Args:
            log: What is played.
            settings: How.
            site_origin: Where the site is.
            ground_z_m: The ground's height everywhere about it, onto which poses are put.
            eyes_z_m: Height of the eyes where one can stand, for estimators that measure by it.
            eye_height_m: Of the eyes above the ground.
            console: The operator's, if there is one.

        Raises:
            UnknownEstimator, MissingSensor: The estimator cannot run on this log.
            MissingSensor: No estimator can.
        """
        self._log, self._settings, self._console = log, settings, console
        self._placing = Placing(site_origin, ground_z_m, eyes_z_m, eye_height_m, settings.anchor, settings.height)
        self._origin = self._placing.origin(log.info.first_fix)
        self._aligner = Aligner(self._placing)
        self._rig = _display_rig(log)
        self._vision: VisionThread | None = None
        self.estimator = settings.estimator or self._best()
        self._make_pipeline(self.estimator)  # an error in the choice is the caller's to report, not a thread's
        recording: Recording = log if log.info.counts["frames"] else BlankCamera(log)
        self._reading = ReadAhead(recording)
        playback = Playback(self._reading, log.info.t_start_ns, self._make_pipeline, Upright(log.rig))
        span = (log.info.t_start_ns, log.info.t_end_ns)
        self.player = Player(
            playback,
            span,
            estimator=self.estimator,
            looping=settings.looping,
            show=self._show,
            report=self._report,
        )
        self._link: RigLink | None = None
        self._presenter: Presenter | None = None

    def _best(self) -> str:
        """What nobody can place on the square plays as its truth, or not at all: the last name then says what is missing."""
        info, rig = self._log.info, self._log.rig
        placed = [name for name in PREFERENCE if name == "truth" or info.counts["gps"] > 0]
        return next((name for name in placed if missing_sensors(name, info, rig) is None), "gps-imu/famm")

    def _make_pipeline(self, name: str) -> Pipeline:
        eyes_z_m, look_again = self._placing.eyes_for(name), self._settings.look_again
        pipeline = make_pipeline(name, self._log, self._origin, eyes_z_m=eyes_z_m, look_again=look_again)
        pipeline = self._placing.levelled(pipeline)
        if self._vision is not None:
            self._vision.close()
            self._vision = None
        if pipeline.front_end is not None:
            self._vision = VisionThread(pipeline.front_end)
            pipeline.front_end = self._vision
        if self._console is not None:
            self._console.clear()
        return pipeline

    def start(self, rig_url: str, token: str, trust: str | None = None) -> None:
        """Connect to the server, see `RigLink`, and play."""
        self._link = RigLink(rig_url, token, self._control, trust)
        self._presenter = Presenter(self._link, self._rig, self._console)
        self._link.send_state(self._description())
        self.player.start()

    @property
    def error(self) -> BaseException | None:
        """What ended the player or its link, if anything did."""
        return self.player.error or (self._link.refused if self._link else None)

    def close(self) -> None:
        """Stop playing and end every thread."""
        self.player.close()
        if self._link is not None:
            self._link.close()
        self._reading.close()
        if self._vision is not None:
            self._vision.close()

    # -- to the server ------------------------------------------------------------------------------------------------

    def _description(self) -> dict[str, object]:
        log = self._log
        missing = {name: missing_sensors(name, log.info, log.rig) for name in ESTIMATORS}
        return {
            "kind": "replay",
            "log": log.name,
            "duration_s": log.info.duration_s,
            "estimator": self.estimator,
            "estimators": list(ESTIMATORS),
            "unavailable": {name: f"This walk has {reason}." for name, reason in missing.items() if reason},
            "anchor": self._settings.anchor,
            "notice": self._notice(),
            "playback": _playback(self.player.state),
        }

    def _notice(self) -> str | None:
        """Return what a viewer should know of this log, most important first."""
        info, fix = self._log.info, self._log.info.first_fix
        if info.truncated:
            return f"The recording breaks off after {info.duration_s:.0f} s; it plays to there."
        if self._settings.anchor == "site" and fix is not None and (away_m := distance_m(fix, self._origin)) > FAR_M:
            return f"This walk was recorded {away_m / 1000.0:,.0f} km from the site: replay it with --anchor here."
        if not info.counts["frames"]:
            return "This walk has no camera: the square is drawn over an empty picture."
        if self._log.rig.camera is None:
            return UNCALIBRATED
        return None

    def _show(self, shown: Shown, state: PlayerState, did_seek: bool) -> None:
        if self._presenter is not None:
            pose = self._placing.placed(shown.pose, state.estimator)
            self._aligner.note(shown.frame, pose)
            self._presenter.show(shown, pose, estimator=state.estimator, position_s=state.position_s, did_seek=did_seek)

    def _report(self, state: PlayerState) -> None:
        if self._link is not None:
            notice = "Working out the pose there ..." if state.seeking else self._notice()
            self._link.send_state({"playback": _playback(state), "estimator": state.estimator, "notice": notice})

    def _control(self, request: ControlRequest) -> ControlReply:
        try:
            if request.action == "align":
                assert self._rig.camera is not None  # a guessed one, if none is known
                said = self._aligner.said(request, self._rig.camera)
                self.player.command("say", said).result()
                return ControlReply(request.request_id, ok=True)
            assert request.action != "share"  # the link answers that itself
            did_seek = self.player.command(request.action, request.value).result()
        except InputError as error:
            return ControlReply(request.request_id, ok=False, error=str(error))
        except CancelledError:
            return ControlReply(request.request_id, ok=False, error="The replay has ended.")
        return ControlReply(request.request_id, ok=True, did_seek=did_seek)


def _playback(state: PlayerState) -> dict[str, object]:
    return {
        "playing": state.playing,
        "position_s": state.position_s,
        "speed": state.speed,
        "looping": state.looping,
    }


def _display_rig(log: Log) -> Rig:
    """Return a rig that a picture can be drawn with: an unknown camera is guessed from the size of its first picture."""
    if log.rig.camera is not None:
        return log.rig
    if not log.info.counts["frames"]:
        return replace(log.rig, camera=CAMERA)
    for measurement in log.messages(truth=False):
        if isinstance(measurement, Frame):
            try:
                height_px, width_px = measurement.picture.gray().shape
            except MalformedInput:
                continue
            return replace(log.rig, camera=guessed_camera(width_px, height_px))
    return replace(log.rig, camera=CAMERA)
