"""How each sensor is, in one word for programs and one sentence for people. Pure: the clock is the caller's."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType

from tracker.sources.source import SourceStatus


class SensorState(Enum):
    """What a sensor does; all but the first two are troubles."""

    WAITING = "waiting"
    """It has just been opened, and nothing has come yet."""
    STREAMING = "streaming"
    SILENT = "silent"
    """It is there and says nothing."""
    STUCK = "stuck"
    """It says the same again and again, which no working sensor does."""
    UNUSABLE = "unusable"
    """It says that it knows nothing: no fix, a black picture."""
    LOST = "lost"
    """It is gone; it is looked for again and again."""
    FAILED = "failed"
    """It can never work as it was asked for; nobody tries again."""

    @property
    def is_trouble(self) -> bool:
        """Whether somebody should do something."""
        return self not in (SensorState.WAITING, SensorState.STREAMING)


@dataclass(frozen=True, slots=True)
class SensorKind:
    """What people call a kind of sensor, and what is usual for it."""

    title: str
    unit: str
    silent_s: float
    """It is silent when nothing has come for so long."""
    silent_remedy: str
    stuck: str
    unusable: str


KINDS: Mapping[str, SensorKind] = MappingProxyType(
    {
        "gps": SensorKind(
            "The GPS receiver",
            "messages",
            3.0,
            "check its plug and its antenna",
            "repeats one position while you walk: pull it out and put it back",
            "has no fix: it needs open sky, and up to a minute after it was switched on",
        ),
        "imu": SensorKind(
            "The inertial unit",
            "samples",
            0.5,
            "check its plug",
            "repeats one value: pull it out and put it back",
            "says nothing that can be used: pull it out and put it back",
        ),
        "camera": SensorKind(
            "The camera",
            "pictures",
            1.5,
            "check its plug, and that no other program uses it",
            "repeats one picture: pull it out and put it back",
            "sees nothing that could be followed: is its lens covered, or is it dark",
        ),
    }
)


@dataclass(frozen=True, slots=True)
class Health:
    """How a sensor was when it was looked at."""

    state: SensorState
    rate_hz: float
    """Of what came within the last two seconds or so."""
    sentence: str
    """What is the matter and what to do, or that all is well; one sentence without a name of a person or a file."""
    count: int
    """Measurements since the beginning."""
    restarts: int = 0
    counts: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    """What was refused, by reason, by the source itself and by the guard."""
    facts: Mapping[str, object] = field(default_factory=lambda: MappingProxyType({}))
    """What the source says of itself."""
    detail: str = ""
    """The device, in its source's words."""

    def as_json(self) -> dict[str, object]:
        """Return it as JSON values."""
        return {
            "state": self.state.value,
            "rate_hz": round(self.rate_hz, 1),
            "sentence": self.sentence,
            "count": self.count,
            "restarts": self.restarts,
            "counts": dict(self.counts),
            "facts": dict(self.facts),
            "detail": self.detail,
        }


#: The rate is of the measurements within this time, of at most so many.
_RATE_S, _RATE_MOST = 2.0, 1024
#: What has waited, and then comes all at once, did not come a million times a second.
_LEAST_S = 0.1
#: What a device said just before it was pulled out may still be on its way.
_UNPLUGGED_NS = 200_000_000


class Watch:
    """Follows one sensor. Its methods are called by one thread; `now_ns` never goes back."""

    def __init__(self, name: str, now_ns: int) -> None:
        self.name = name
        self._kind = KINDS[name]
        self._times_ns: deque[int] = deque(maxlen=_RATE_MOST)
        self._count = self._restarts = 0
        self._since_ns = now_ns
        self._newest_ns: int | None = None
        self._lost: str | None = None
        self._failed: str | None = None
        self.is_stuck = False
        """Whether the guard withholds what it says, since it is always the same."""
        self.is_unusable = False
        """Whether what it says is of no use."""

    def opened(self, now_ns: int) -> None:
        """Note that its source was started, at first or again."""
        self._since_ns = now_ns

    def arrived(self, now_ns: int) -> None:
        """Note a measurement."""
        self._count += 1
        self._times_ns.append(now_ns)
        self._newest_ns = now_ns
        self._lost = None

    def lost(self, reason: str) -> None:
        """Note that its source has ended; it will be started again."""
        self._lost, self._restarts = reason, self._restarts + 1
        self._times_ns.clear()
        self.is_stuck = self.is_unusable = False

    def failed(self, reason: str) -> None:
        """Note that its source has given up for good."""
        self._failed = reason

    def read(self, now_ns: int, status: SourceStatus | None = None) -> Health:
        """Return how it is; `status` is what its source says of itself."""
        while self._times_ns and now_ns - self._times_ns[0] > _RATE_S * 1e9:
            self._times_ns.popleft()
        state, what = self._judge(now_ns, status)
        return Health(
            state,
            self._rate_hz(now_ns),
            what if what.startswith(self._kind.title) else f"{self._kind.title} {what}",
            self._count,
            self._restarts,
            MappingProxyType(dict(status.counts)) if status else MappingProxyType({}),
            MappingProxyType(dict(status.facts)) if status else MappingProxyType({}),
            status.detail if status else "",
        )

    def _judge(self, now_ns: int, status: SourceStatus | None) -> tuple[SensorState, str]:
        kind = self._kind
        if self._failed is not None:
            return SensorState.FAILED, f"cannot be used: {_clause(self._failed)}."
        if self._lost is not None:
            what = "is gone" if self._count else "is not there"
            return SensorState.LOST, f"{what}: {_clause(self._lost)}. It is looked for again and again."
        if status is not None and not status.attached and self._is_unplugged(now_ns):
            return SensorState.LOST, f"is not there: {_clause(status.detail)}."
        if self._newest_ns is None:
            if now_ns - self._since_ns <= kind.silent_s * 1e9:
                return SensorState.WAITING, "is being opened."
            return SensorState.SILENT, f"has said nothing yet: {kind.silent_remedy}."
        if self._is_quiet(now_ns):
            silent_s = (now_ns - self._newest_ns) * 1e-9
            return SensorState.SILENT, f"has said nothing for {silent_s:.0f} s: {kind.silent_remedy}."
        if self.is_stuck:
            return SensorState.STUCK, f"{kind.stuck}."
        if self.is_unusable:
            return SensorState.UNUSABLE, f"{kind.unusable}."
        return SensorState.STREAMING, f"is well: {self._rate_hz(now_ns):.0f} {kind.unit} a second."

    def _is_unplugged(self, now_ns: int) -> bool:
        """Return whether a device that its source says is not there has been there, or has had its time to come."""
        if self._newest_ns is None:
            return self._is_quiet(now_ns)
        return now_ns - self._newest_ns > _UNPLUGGED_NS

    def _is_quiet(self, now_ns: int) -> bool:
        since_ns = self._since_ns if self._newest_ns is None else self._newest_ns
        return now_ns - since_ns > self._kind.silent_s * 1e9

    def _rate_hz(self, now_ns: int) -> float:
        if len(self._times_ns) < 2:
            return 0.0
        # over the time since the first, not between first and last: what has stopped slows down
        return len(self._times_ns) / max((now_ns - self._times_ns[0]) * 1e-9, _LEAST_S)


def _clause(sentence: str) -> str:
    return sentence.rstrip().rstrip(".")
