"""A pipeline put together for a rig at a place and a date: the same one for a recorded walk and for a live one."""

from tracker.estimator import Estimator, Origin
from tracker.estimators import PRECISE, Settings, build
from tracker.geomagnetism import magnetic_field
from tracker.pipeline import Pipeline
from tracker.precise.ground import EyeHeight
from tracker.precise.memory import Memory
from tracker.retractable import Retractable
from tracker.rig import Rig
from tracker.vision import VisionFrontEnd


def assemble(
    name: str,
    *,
    origin: Origin,
    rig: Rig,
    date_ns: int,
    truth_origin: Origin | None = None,
    settings: Settings | None = None,
    eyes_z_m: EyeHeight | None = None,
    looks: bool = True,
    memory: Memory | None = None,
) -> Pipeline:
    """Return a new pipeline.

    Args:
        name: One of `ESTIMATORS`.
        origin: Where the site frame is laid.
        rig: Extrinsics and camera.
        date_ns: Nanoseconds since 1970, for the Earth's magnetic field.
        truth_origin: Where the map frame of a log's truth is laid; None where it is the site's.
        settings: None for the defaults.
        eyes_z_m: Height of the rig in that frame where it stands on the ground; None where no ground is known.
        memory: What the same rig had learned at its last start; None where nothing is known.
        looks: Whether it has a front end of its own; else it is fed what another one made of the pictures.

    Raises:
        UnknownEstimator: No estimator has that name.
    """
    earth = magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, date_ns)

    def make() -> Estimator:
        return build(
            name,
            origin=origin,
            rig=rig,
            declination_rad=earth.declination_rad,
            earth_field=earth,
            truth_origin=truth_origin,
            settings=settings,
            eyes_z_m=eyes_z_m,
            memory=memory,
        )

    # only `precise` listens to what visitors say
    estimator = Retractable(make) if name.endswith(f"/{PRECISE}") else make()
    has_eyes = looks and rig.camera is not None and estimator.uses_camera
    return Pipeline(estimator, VisionFrontEnd(rig.camera) if has_eyes and rig.camera else None)
