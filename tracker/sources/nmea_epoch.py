"""Sentences of one moment, put together by the UTC time that they say, without waiting for more than is to come."""

from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from tracker.sources.nmea_sentence import Gga, Gst, Rmc, Sentence, Timed, Vtg

#: An epoch waits for the sentences that came in most of so many epochs before it.
_REMEMBERED = 3


@dataclass(slots=True)
class Epoch:
    """What a receiver said of one moment."""

    time_of_day_ns: int | None
    """UTC; None where the receiver does not know it."""
    t_first_ns: int
    """When its first sentence began to be here."""
    gga: Gga | None = None
    rmc: Rmc | None = None
    vtg: Vtg | None = None
    gst: Gst | None = None
    fix_given: bool = False
    velocity_given: bool = False
    seen: set[type] = field(default_factory=set)

    def add(self, sentence: Sentence) -> None:
        """Add a sentence of a kind that is not in yet."""
        self.seen.add(type(sentence))
        match sentence:
            case Gga():
                self.gga = sentence
            case Rmc():
                self.rmc = sentence
            case Vtg():
                self.vtg = sentence
            case Gst():
                self.gst = sentence
            case _:
                pass


class EpochAssembler:
    """Gives out each epoch as soon as all is in that its receiver usually says of one, and at the latest when the next begins.

    Which sentence ends an epoch differs by receiver and by its settings, so the kinds seen in most of the last three are waited
    for; one that is lost costs one epoch's wait. VTG says no time, and is waited for only where RMC, which says the same, does
    not come. A receiver of the latter kind that sends VTG before GGA, heard from between the two on, would be read one epoch off.
    """

    def __init__(self, counts: Counter[str]) -> None:
        self._counts = counts
        self._epoch: Epoch | None = None
        self._history: deque[frozenset[type]] = deque(maxlen=_REMEMBERED)
        self._early_vtg: Vtg | None = None

    def take(self, sentence: Gga | Rmc | Vtg | Gst | Timed, t_ns: int) -> Iterator[Epoch]:
        """Yield the epochs that have something to give: a fix, a velocity or both that were not given before.

        Args:
            sentence: The next one.
            t_ns: When it began to be here.
        """
        if isinstance(sentence, Timed) and sentence.time_of_day_ns is None:
            return
        if isinstance(sentence, Vtg):
            if self._epoch is None or Vtg in self._epoch.seen:
                self._early_vtg = sentence
                return
        elif self._begins(sentence):
            yield from self.close()
            self._begin(sentence, t_ns)
        elif type(sentence) in self._current.seen and not isinstance(sentence, Timed):
            self._counts["repeated"] += 1
            return
        epoch = self._current
        epoch.add(sentence)
        if epoch.time_of_day_ns is None and not isinstance(sentence, Vtg):
            epoch.time_of_day_ns = sentence.time_of_day_ns
        if epoch.fix_given or self._awaited() <= epoch.seen:
            yield epoch

    def close(self) -> Iterator[Epoch]:
        """End the present epoch: the next begins, or nothing more comes. It is yielded where it has something to give."""
        if self._epoch is None:
            return
        kinds = frozenset(self._epoch.seen - {Timed})
        if kinds:
            self._history.append(kinds)
        if not self._epoch.fix_given:
            yield self._epoch
        self._epoch = None

    @property
    def _current(self) -> Epoch:
        assert self._epoch is not None
        return self._epoch

    def _begins(self, sentence: Gga | Rmc | Gst | Timed) -> bool:
        if self._epoch is None:
            return True
        if sentence.time_of_day_ns is not None and self._epoch.time_of_day_ns is not None:
            return sentence.time_of_day_ns != self._epoch.time_of_day_ns
        return type(sentence) in self._epoch.seen  # without a time, the same kind again is the next epoch

    def _begin(self, sentence: Gga | Rmc | Gst | Timed, t_ns: int) -> None:
        self._epoch = Epoch(sentence.time_of_day_ns, t_ns)
        if self._early_vtg is not None:
            self._epoch.add(self._early_vtg)
            self._early_vtg = None

    def _awaited(self) -> set[type]:
        """Return the kinds to wait for; before anything is known, one that never comes."""
        seen = Counter(kind for kinds in self._history for kind in kinds)
        enough = 2 if len(self._history) == _REMEMBERED else 1
        awaited = {kind for kind, times in seen.items() if times >= enough}
        return awaited - {Vtg} if Rmc in awaited else awaited or {type(None)}
