"""A recorded walk pushed to the server as a rig would push it: log, estimator, threads and link joined."""

from concurrent.futures import CancelledError
from dataclasses import dataclass
from time import monotonic_ns

from server.aligning import Aligner
from server.figures import FigureTeller
from server.fitting import best_estimator, display_rig
from server.messages import ControlReply, ControlRequest
from server.placing import Anchor, Height, Placing
from server.presenting import Presenter
from server.push import RigLink
from server.settings import choose
from server.standing import FAR_M, distance_m
from tracker.blank import BlankCamera
from tracker.errors import InputError
from tracker.estimator import Origin
from tracker.estimators import ESTIMATORS, missing_sensors
from tracker.evaluate import make_pipeline
from tracker.grounding import GroundHeight
from tracker.log import Log
from tracker.pipeline import Pipeline
from tracker.playback import Playback, Recording, Shown
from tracker.precise.ground import EyeHeight
from tracker.runner import Player, PlayerState, ReadAhead, VisionThread
from tracker.upright import Upright

#: Said of a camera whose lens is guessed.
UNCALIBRATED = "This camera was never calibrated: a lens 60 degrees wide is assumed, so the square may not fit."


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
    ) -> None:
        """Prepare a replay; `start` starts it.

        Args:
            log: What is played.
            settings: How.
            site_origin: Where the site is.
            ground_z_m: The ground's height everywhere about it, onto which poses are put.
            eyes_z_m: Height of the eyes where one can stand, for estimators that measure by it.
            eye_height_m: Of the eyes above the ground.

        Raises:
            UnknownEstimator, MissingSensor: The estimator cannot run on this log.
            MissingSensor: No estimator can.
        """
        self._log, self._settings = log, settings
        self._placing = Placing(site_origin, ground_z_m, eyes_z_m, eye_height_m, settings.anchor, settings.height)
        self._origin = self._placing.origin(log.info.first_fix)
        self._aligner = Aligner(self._placing)
        self._rig = display_rig(log)
        self._vision: VisionThread | None = None
        self._changed: tuple[str, ...] = ()
        """Settings of the estimators that an operator has chosen, `KEY=VALUE`."""
        self._figures = FigureTeller(self._send_text, log.info.t_start_ns, monotonic_ns)
        self.estimator = settings.estimator or best_estimator(log)
        self._make_pipeline(self.estimator)  # an error in the choice is the caller's to report, not a thread's
        recording: Recording = log if log.info.counts["frames"] else BlankCamera(log)
        self._reading = ReadAhead(recording)
        self._playback = Playback(self._reading, log.info.t_start_ns, self._make_pipeline, Upright(log.rig))
        span = (log.info.t_start_ns, log.info.t_end_ns)
        self.player = Player(
            self._playback,
            span,
            estimator=self.estimator,
            looping=settings.looping,
            show=self._show,
            report=self._report,
        )
        self._link: RigLink | None = None
        self._presenter: Presenter | None = None

    def _make_pipeline(self, name: str) -> Pipeline:
        eyes_z_m, look_again = self._placing.eyes_for(name), self._settings.look_again
        chosen = choose(self._changed)
        pipeline = make_pipeline(name, self._log, self._origin, chosen, eyes_z_m, look_again=look_again)
        pipeline = self._placing.levelled(pipeline)
        if self._vision is not None:
            self._vision.close()
            self._vision = None
        if pipeline.front_end is not None:
            self._vision = VisionThread(pipeline.front_end)
            pipeline.front_end = self._vision
        self._figures.begin()
        return pipeline

    def start(self, rig_url: str, token: str, trust: str | None = None) -> None:
        """Connect to the server, see `RigLink`, and play."""
        self._link = RigLink(rig_url, token, self._control, trust)
        self._presenter = Presenter(self._link, self._rig)
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
            "utc_offset_s": log.info.utc_offset_s,
            "notice": self._notice(),
            "playback": _playback(self.player.state),
        }

    def _notice(self) -> str | None:
        """Return what a viewer should know of this log, most important first."""
        info, fix = self._log.info, self._log.info.first_fix
        if self._changed:
            return f"An operator has changed settings of the estimator: {', '.join(self._changed)}."
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
            if pose is not None:
                self._presenter.show_pose(pose, state.estimator, did_seek=did_seek)
        pipeline = self._playback.pipeline
        self._figures.look(pipeline.innovations(), pipeline.rejected)

    def _send_text(self, text: str) -> None:
        if self._link is not None:
            self._link.send_text(text)

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
            if request.action == "figures":
                self._figures.ask()
                return ControlReply(request.request_id, ok=True)
            if request.action == "settings":
                self._change_settings(request.value)
                return ControlReply(request.request_id, ok=True, did_seek=True)
            assert request.action != "share"  # the link answers that itself
            did_seek = self.player.command(request.action, request.value).result()
        except InputError as error:
            return ControlReply(request.request_id, ok=False, error=str(error))
        except CancelledError:
            return ControlReply(request.request_id, ok=False, error="The replay has ended.")
        return ControlReply(request.request_id, ok=True, did_seek=did_seek)

    def _change_settings(self, value: object) -> None:
        """Take one setting, or with an empty text the usual ones again, and work the walk out anew."""
        if not isinstance(value, str):
            raise InputError("A setting is written KEY=VALUE: `agora settings` lists them all.")
        key = value.partition("=")[0].strip()
        kept = [pair for pair in self._changed if pair.partition("=")[0] != key]
        changed = (*kept, value) if value else ()
        choose(changed)
        before, self._changed = self._changed, changed
        try:
            self.player.command("estimator", self.player.state.estimator).result()
        except InputError:
            self._changed = before
            raise


def _playback(state: PlayerState) -> dict[str, object]:
    return {
        "playing": state.playing,
        "position_s": state.position_s,
        "speed": state.speed,
        "looping": state.looping,
    }
