"""The tracker on real recordings that lie beside the checkout: what a picture must show, and how far off a walk may be."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker import lens, two_view
from tracker.estimator import Pose
from tracker.evaluate import figures, log_origin, make_pipeline, run
from tracker.geometry import matrix_from_wxyz
from tracker.log import Log
from tracker.measurements import Frame, Image, Matrix

#: A phone's picture is stored on its side: what is horizontal to the eye is its height.
UPRIGHT_WIDTH_PX = 360


def _seen(log: Log, name: str) -> list[tuple[Frame, Pose]]:
    """Every picture with the pose of its capture, as a replay shows it."""
    pipeline, found = make_pipeline(name, log, log_origin(log)), []
    for measurement in log.messages():
        pipeline.step(measurement)
        if isinstance(measurement, Frame):
            pose = pipeline.predict(measurement.t_ns)
            if pose is not None:
                found.append((measurement, pose))
    return found


def _R_site_cam(log: Log, pose: Pose) -> Matrix:
    return np.asarray(matrix_from_wxyz(pose.wxyz_site_body) @ log.rig.T_body_cam[:3, :3])


def _rotation_by_pictures(log: Log, a: Image, b: Image) -> Matrix:
    """Return R_a_b by features of two pictures of one scene, taken from one place."""
    assert log.rig.camera is not None
    sift, matcher = cv2.SIFT.create(1500), cv2.BFMatcher()
    (points_a, found_a), (points_b, found_b) = (sift.detectAndCompute(picture, None) for picture in (a, b))
    pairs = [m for m, second in matcher.knnMatch(found_a, found_b, k=2) if m.distance < 0.7 * second.distance]
    assert len(pairs) > 100
    pixels = (
        np.array([p.pt for p in points_a])[[m.queryIdx for m in pairs]],
        np.array([p.pt for p in points_b])[[m.trainIdx for m in pairs]],
    )
    rays_a, rays_b = (two_view.bearings(lens.unproject(log.rig.camera, px)) for px in pixels)
    return two_view.fit_rotation(rays_a, rays_b, 0.002)


@pytest.mark.parametrize("name", ["gps-imu/famm", "camera-gps-imu/famm"])
def test_a_full_turn_closes(shared: Path, name: str) -> None:
    """At its end the columns stand where they stood at its start, within 5 % of the width; the visitor has not moved."""
    log = Log.open(shared / "data" / "transformflow-1606.mcap")
    seen = _seen(log, name)
    assert log.rig.camera is not None
    assert all(pose.heading_known for _, pose in seen)
    (first, before), (last, after) = seen[6], seen[-1]
    R_pictures = _rotation_by_pictures(log, first.picture.gray(), last.picture.gray())
    R_poses = _R_site_cam(log, before).T @ _R_site_cam(log, after)
    columns = np.array([[120.0, 90.0], [240.0, 180.0], [360.0, 270.0]])
    rays = two_view.bearings(lens.unproject(log.rig.camera, columns))
    by_pictures, by_poses = (
        lens.project(log.rig.camera, (turned := rays @ R)[:, :2] / turned[:, 2:]) for R in (R_pictures, R_poses)
    )
    assert np.abs(by_poses - by_pictures)[:, 1].max() < 0.05 * UPRIGHT_WIDTH_PX
    places = np.array([pose.p_site_m for _, pose in seen])
    assert np.ptp(places[:, :2], axis=0).max() < 0.2


def test_a_rolled_phone_keeps_its_heading(shared: Path) -> None:
    """A full roll about the lens: the compass turns by 352 degrees, the phone looks along one street all the while."""
    log = Log.open(shared / "data" / "transformflow-avonhead-1611.mcap")
    forward = np.array([_R_site_cam(log, pose)[:, 2] for _, pose in _seen(log, "camera-gps-imu/famm")])
    azimuth = np.unwrap(np.arctan2(forward[:, 1], forward[:, 0]))
    assert np.degrees(np.ptp(azimuth)) < 40.0
    assert np.degrees(np.abs(np.arcsin(forward[:, 2]))).max() < 35.0


@pytest.mark.parametrize("name", ["gps-imu/cmm", "gps-imu/famm"])
def test_a_real_walk_is_as_good_as_its_receiver(shared: Path, name: str) -> None:
    """And better than holding each fix until the next."""
    found = figures(run(Log.open(shared / "data" / "walk0827-a.mcap"), name))
    assert found["truth"]["ate_rmse_m"] < 1.1 * found["gps"]["ate_rmse_m"]
    assert found["truth"]["ate_rmse_m"] < found["gps"]["held_ate_rmse_m"]
    assert found["truth"]["heading_rmse_deg"] is None
