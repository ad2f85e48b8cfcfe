"""What a receiver's motion says of north: the course over the ground, and the gains of velocity beside what the IMU felt."""

from tracker.heading import StartHeading
from tracker.inertial import InertialPath
from tracker.measurements import GpsVelocity, Vector3

#: A course from two fixes spans about this long: between closer ones it would be noise, between further ones it is history.
SPAN_S = (0.9, 3.0)


class CourseOverGround:
    """Feeds the start heading from fixes or, where the receiver tells them, from velocities."""

    def __init__(self) -> None:
        self._fix: tuple[int, Vector3] | None = None
        self._velocity: tuple[GpsVelocity, tuple[float, float]] | None = None
        """A velocity, and what the IMU had felt by then."""

    def fix(self, t_ns: int, p_site_m: Vector3, path: InertialPath, heading: StartHeading) -> None:
        """Take a position: a course runs from the one a second before."""
        old = self._fix
        if heading.yaw_offset_rad is not None or (old is not None and (t_ns - old[0]) * 1e-9 < SPAN_S[0]):
            return
        self._fix = (t_ns, p_site_m)
        middle = path.at((t_ns + old[0]) // 2) if old is not None else None
        if old is not None and middle is not None and (t_ns - old[0]) * 1e-9 < SPAN_S[1]:
            dt_s = (t_ns - old[0]) * 1e-9
            (x, y, z), (ox, oy, oz) = p_site_m, old[1]
            heading.course(((x - ox) / dt_s, (y - oy) / dt_s, (z - oz) / dt_s), middle.wxyz_level_body)

    def velocity(self, velocity: GpsVelocity, path: InertialPath, heading: StartHeading) -> None:
        """Take a velocity: it is a course, and its gain since the one a second before is what the IMU felt, turned."""
        here = path.at(velocity.t_ns)
        if heading.is_final or here is None:
            return
        if self._velocity is not None:
            before, felt = self._velocity
            dt_s = (velocity.t_ns - before.t_ns) * 1e-9
            if dt_s < SPAN_S[0]:
                return
            if dt_s < SPAN_S[1]:
                (x, y, _), (ox, oy, _) = velocity.v_enu_m_s, before.v_enu_m_s
                gained = here.gained_level_m_s
                heading.gain((gained[0] - felt[0], gained[1] - felt[1]), (x - ox, y - oy))
        self._velocity = (velocity, here.gained_level_m_s)
        heading.course(velocity.v_enu_m_s, here.wxyz_level_body)
