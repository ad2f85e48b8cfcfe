"""The tracker's errors, drawn as a tree.

    TrackerError
    ├── InputError            what the user gave cannot be used; the command line prints it and exits 2
    │   ├── MalformedInput    bytes that are not what they claim to be
    │   ├── MissingSensor     a log or rig lacks what the chosen estimator needs
    │   └── UnknownEstimator  no estimator of that name
    ├── SourceLost            a device went away (the supervisor's business)
    ├── SourceOverrun         a queue that may lose nothing is full
    └── EstimatorDiverged     a filter's numbers are no longer finite

A bad measurement is not an error: it is an `Outcome`, returned and counted.
"""


class TrackerError(Exception):
    """Root of everything that the tracker raises on purpose."""


class InputError(TrackerError):
    """Input that cannot be used. The message is one sentence that names the thing and the remedy."""


class MalformedInput(InputError):
    """Bytes from a file, socket or sensor that do not parse."""


class MissingSensor(InputError):
    """A sensor that the chosen estimator needs is not there."""


class UnknownEstimator(InputError):
    """No estimator has that name."""


class SourceLost(TrackerError):
    """A device or stream ended without being asked to."""


class SourceOverrun(TrackerError):
    """A queue that must lose nothing is full."""


class EstimatorDiverged(TrackerError):
    """An estimate is not finite any more."""
