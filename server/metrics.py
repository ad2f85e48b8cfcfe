"""`/metrics` as Prometheus reads it: figures taken from the sessions at the moment they are asked for."""

from collections.abc import Iterator
from typing import Final

from prometheus_client import CollectorRegistry, ProcessCollector, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, HistogramMetricFamily
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector

from server.cluster.relay import Relay
from server.session import Session
from server.sessions import Sessions
from server.traffic import Durations

_COUNTERS: Final = (
    ("frames", "Frames that came from the rig."),
    ("poses", "Poses that came from the rig."),
    ("received_bytes", "Bytes of frames and poses that came from the rig."),
    ("frames_sent", "Frames that went to viewers, counted for each."),
    ("frames_dropped", "Frames that a newer one replaced before a viewer could take them."),
    ("poses_sent", "Poses that went to viewers, counted for each."),
    ("poses_dropped", "Poses that a newer one replaced before a viewer could take them."),
)
_GAUGES: Final = (
    ("viewers", "Viewers connected."),
    ("rig_connected", "Whether the rig is connected to this server."),
    ("frame_age_seconds", "Since the newest frame came from a rig of this server."),
    ("pose_age_seconds", "Since the newest pose came so, by itself or with a frame."),
)


class Metrics:
    """The page of one server."""

    content_type: Final = "text/plain; version=0.0.4; charset=utf-8"

    def __init__(self, sessions: Sessions, relay: Relay | None = None) -> None:
        self._registry = CollectorRegistry(auto_describe=False)
        self._figures = _SessionFigures(sessions)
        if relay is not None:
            self._registry.register(_ClusterFigures(relay))
        self._registry.register(self._figures)
        ProcessCollector(registry=self._registry)

    def page(self, tasks: int = 0) -> bytes:
        """Return the page; `tasks` is how many the event loop has."""
        self._figures.tasks = tasks
        return generate_latest(self._registry)


class _SessionFigures(Collector):
    """Nothing is kept here, so a session that is gone leaves no series behind."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions
        self.tasks = 0

    def collect(self) -> Iterator[Metric]:
        """Yield every family."""
        yield GaugeMetricFamily("agora_sessions", "Sessions, with a rig or without.", value=len(list(self._sessions)))
        yield GaugeMetricFamily("agora_tasks", "Tasks of the event loop: three for each WebSocket.", value=self.tasks)
        traffic = self._sessions.traffic
        refused = CounterMetricFamily("agora_refused", "Connections and messages turned away.", labels=["reason"])
        for reason, count in sorted(traffic.refused.items()):
            refused.add_metric([reason], count)
        yield refused
        yield _histogram("frame", traffic.frames)
        yield _histogram("pose", traffic.poses)
        figures = [(session.name, _figures(session, self._sessions.now_ns())) for session in self._sessions]
        for kind, families in ((CounterMetricFamily, _COUNTERS), (GaugeMetricFamily, _GAUGES)):
            for name, meaning in families:
                family = kind(f"agora_{name}", meaning, labels=["session"])
                for session, values in figures:
                    if (value := values[name]) is not None:
                        family.add_metric([session], value)
                yield family


class _ClusterFigures(Collector):
    """Of the servers that this one is joined to."""

    def __init__(self, relay: Relay) -> None:
        self._relay = relay

    def collect(self) -> Iterator[Metric]:
        """Yield both families."""
        yield GaugeMetricFamily(
            "agora_servers", "Servers that are one, with this one.", value=len(self._relay.peers) + 1
        )
        connected = int(self._relay.bus.connected)
        yield GaugeMetricFamily(
            "agora_bus_connected", "Whether the way to the other servers is there.", value=connected
        )


def _histogram(what: str, durations: Durations) -> HistogramMetricFamily:
    return HistogramMetricFamily(
        f"agora_{what}_fanout_seconds",
        f"From a {what}'s arrival at the server to its leaving for one viewer.",
        buckets=durations.cumulative(),
        sum_value=durations.sum_s,
    )


def _figures(session: Session, now_ns: int) -> dict[str, float | None]:
    tally = session.tally
    return {
        "frames": session.frames,
        "poses": session.poses,
        "received_bytes": session.received_bytes,
        "frames_sent": tally.frames_sent,
        "frames_dropped": tally.frames_dropped,
        "poses_sent": tally.poses_sent,
        "poses_dropped": tally.poses_dropped,
        "viewers": len(session.viewers),
        "rig_connected": int(session.connected and not session.elsewhere),
        # another server's comes only while somebody watches it here
        "frame_age_seconds": None if session.elsewhere else _age_s(session.t_frame_ns, now_ns),
        "pose_age_seconds": None if session.elsewhere else _age_s(session.t_pose_ns, now_ns),
    }


def _age_s(t_ns: int | None, now_ns: int) -> float | None:
    return None if t_ns is None else (now_ns - t_ns) * 1e-9
