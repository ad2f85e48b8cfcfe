"""The renderer against OpenCV: what is drawn lies where `cv2.projectPoints` says."""

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from assets.gltf import Node, Scene
from assets.lens import Pinhole
from assets.materials import MATERIALS
from assets.projection import FAR_M, NEAR_M, depths, projection_from_pinhole
from assets.render import Renderer
from assets.shape import Place, Shape
from assets.sun import sun_direction

Make = Callable[[Scene, int, int], Renderer]
MAGENTA = (255, 0, 255)
INTRINSICS = (420.0, 430.0, 161.3, 118.6)
POINTS = np.array([[-3.0, 12.0, 0.5], [2.5, 9.0, 2.0], [0.0, 40.0, 3.0], [-0.7, 6.0, 0.9], [3.0, 14.0, 4.0]])
LENSES = (
    ("none", ()),
    ("plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0)),
    ("rational_polynomial", (0.1, -0.05, 0.001, 0.0, 0.01, 0.05, 0.0, 0.0)),
    ("equidistant", (0.02, -0.01, 0.0, 0.0)),
)


def looking_north(height_m: float, roll_rad: float) -> NDArray[np.float64]:
    """Return the (4, 4) pose of a camera over the origin, rolled about its line of sight."""
    level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    cos, sin = np.cos(roll_rad), np.sin(roll_rad)
    pose = np.eye(4)
    pose[:3, :3] = level @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    pose[2, 3] = height_m
    return pose


def projected(pose: NDArray[np.float64], model: str, distortion: tuple[float, ...]) -> NDArray[np.float64]:
    inverse = np.linalg.inv(pose)
    local = (POINTS @ inverse[:3, :3].T + inverse[:3, 3]).reshape(-1, 1, 3)
    fx, fy, cx, cy = INTRINSICS
    K, zero = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]), np.zeros(3)
    project = cv2.fisheye.projectPoints if model == "equidistant" else cv2.projectPoints
    coefficients = np.array(distortion) if distortion else np.zeros(4)
    return np.asarray(project(local, zero, zero, K, coefficients)[0], dtype=np.float64).reshape(-1, 2)


def centroid(picture: NDArray[np.uint8], background: NDArray[np.uint8]) -> NDArray[np.float64]:
    weight = np.abs(picture.astype(float) - background).sum(axis=2)
    y, x = np.indices(weight.shape)
    return np.asarray(np.array([(x * weight).sum(), (y * weight).sum()]) / weight.sum())


@pytest.fixture
def plain() -> Scene:
    """A dark wall behind everything, so that a disc's weight is even."""
    shape = Shape()
    shape.polygons(
        "wood", [(-400.0, 90.0, -300.0), (400.0, 90.0, -300.0), (400.0, 90.0, 300.0), (-400.0, 90.0, 300.0)], 0.0
    )
    texture = np.zeros((4, 4, 3), dtype=np.uint8)
    return Scene([Node("wall", shape.meshes(Place.at(0.0, 0.0, 0.0)), {})], {"wood": texture})


@pytest.mark.parametrize(("model", "distortion"), LENSES, ids=[model for model, _ in LENSES])
def test_a_disc_lies_where_opencv_projects_its_point(
    renderer: Make, plain: Scene, model: str, distortion: tuple[float, ...]
) -> None:
    drawing, pose = renderer(plain, 320, 240), looking_north(1.65, 0.1)
    empty = drawing.render(pose, *INTRINSICS, model, distortion)
    for point, expected in zip(POINTS, projected(pose, model, distortion), strict=True):
        picture = drawing.target_scene([point], [MAGENTA], pose, *INTRINSICS, model, distortion, radius_px=5.0)
        assert np.linalg.norm(centroid(picture, empty) - expected) < 0.1


def test_a_disc_has_its_colour_and_lies_over_everything(renderer: Make, plain: Scene) -> None:
    behind = np.array([[0.0, 120.0, 1.65]])
    picture = renderer(plain, 320, 240).target_scene(behind, [(10, 200, 90)], looking_north(1.65, 0.0), *INTRINSICS)
    assert picture[round(INTRINSICS[3]), round(INTRINSICS[2])] == pytest.approx([10, 200, 90], abs=1)


def test_an_edge_of_the_model_lies_where_opencv_projects_it(renderer: Make) -> None:
    shape = Shape()
    shape.polygons("wood", [(-1.0, 10.0, 0.0), (1.0, 10.0, 0.0), (1.0, 10.0, 2.0), (-1.0, 10.0, 2.0)], 0.0)
    scene = Scene(
        [Node("board", shape.meshes(Place.at(0.0, 0.0, 0.0)), {})], {"wood": np.zeros((4, 4, 3), dtype=np.uint8)}
    )
    picture = renderer(scene, 320, 240).render(looking_north(1.0, 0.0), *INTRINSICS).astype(float).sum(axis=2)
    row = picture[round(INTRINSICS[3])]
    dark = 1.0 - (row - row.min()) / (row.max() - row.min())
    fx, _, cx, _ = INTRINSICS
    assert dark.sum() == pytest.approx(2.0 / 10.0 * fx, abs=0.6)
    assert (dark * np.arange(320)).sum() / dark.sum() == pytest.approx(cx, abs=0.2)


def test_the_same_picture_twice(renderer: Make, today: Scene) -> None:
    drawing = renderer(today, 160, 120)
    pose = looking_north(1.65, 0.0)
    first = drawing.render(pose, 130.0, 130.0, 79.5, 59.5)
    drawing.render(looking_north(3.0, 0.5), 130.0, 130.0, 79.5, 59.5)
    assert (drawing.render(pose, 130.0, 130.0, 79.5, 59.5) == first).all()
    assert first.shape == (120, 160, 3)


def test_the_sky_is_up_and_blue_and_the_ground_is_down(renderer: Make, today: Scene) -> None:
    picture = renderer(today, 160, 120).render(looking_north(1.65, 0.0), 130.0, 130.0, 79.5, 59.5).astype(float)
    sky, ground = picture[:10].mean(axis=(0, 1)), picture[-20:].mean(axis=(0, 1))
    assert sky[0] > sky[2]
    assert ground[2] > ground[0]


def test_what_stands_throws_a_shadow(renderer: Make) -> None:
    floor, slab = Shape(), Shape()
    floor.polygons("marble", [(-50.0, -50.0, 0.0), (50.0, -50.0, 0.0), (50.0, 50.0, 0.0), (-50.0, 50.0, 0.0)])
    slab.box("marble", (-4.0, 6.0, 6.0), (4.0, 12.0, 6.2))
    textures = {"marble": MATERIALS["marble"].paint()}
    places = Place.at(0.0, 0.0, 0.0)
    nodes = [Node("floor", floor.meshes(places), {}), Node("slab", slab.meshes(places), {})]
    pose = looking_north(1.65, 0.0)
    lit = renderer(Scene(nodes[:1], textures), 160, 120).render(pose, 130.0, 130.0, 79.5, 59.5).astype(float)
    shaded = renderer(Scene(nodes, textures), 160, 120).render(pose, 130.0, 130.0, 79.5, 59.5).astype(float)
    below = np.array([0.0, 9.0, 6.0]) - np.array(sun_direction()) * 6.0 / sun_direction()[2]
    inverse = np.linalg.inv(pose)
    x, y, z = inverse[:3, :3] @ below + inverse[:3, 3]
    column, row = round(130.0 * x / z + 79.5), round(130.0 * y / z + 59.5)
    assert shaded[row, column].sum() < 0.75 * lit[row, column].sum()
    assert shaded[115, 79] == pytest.approx(lit[115, 79], abs=3.0)


def test_depths_of_the_near_and_far_plane_are_the_ends_of_clip_space() -> None:
    projection = projection_from_pinhole(Pinhole(320, 240, *INTRINSICS))
    for depth, end in ((NEAR_M, -1.0), (FAR_M, 1.0)):
        clip = projection @ np.array([0.0, 0.0, depth, 1.0])
        assert clip[2] / clip[3] == pytest.approx(end)


def test_depths_of_the_buffer_are_metres() -> None:
    """There and back through the projection; the far plane is the sky."""
    projection = projection_from_pinhole(Pinhole(320, 240, *INTRINSICS))
    metres = np.array([0.5, 3.0, 100.0, 2000.0])
    clip = np.column_stack([np.zeros((4, 2)), metres, np.ones(4)]) @ projection.T
    stored = (clip[:, 2] / clip[:, 3] + 1.0) / 2.0
    assert depths(stored) == pytest.approx(metres)
    assert np.isinf(depths(np.ones(1))[0])


def test_how_far_is_what_a_picture_shows(renderer: Make) -> None:
    """A board 10 m ahead before the sky, seen along its normal: the same picture as ever, and one distance all over it."""
    shape = Shape()
    shape.polygons("wood", [(-1.0, 10.0, 0.0), (1.0, 10.0, 0.0), (1.0, 10.0, 2.0), (-1.0, 10.0, 2.0)], 0.0)
    textures = {"wood": np.zeros((4, 4, 3), dtype=np.uint8)}
    drawing = renderer(Scene([Node("board", shape.meshes(Place.at(0.0, 0.0, 0.0)), {})], textures), 320, 240)
    pose = looking_north(1.0, 0.0)
    picture, depth_m = drawing.seen(pose, *INTRINSICS)
    assert (picture == drawing.render(pose, *INTRINSICS)).all()
    fx, fy, cx, cy = INTRINSICS
    x, y = np.meshgrid(np.arange(320), np.arange(240))
    inside = np.maximum(np.abs(x - cx) / fx, np.abs(y - cy) / fy) * 10.0
    assert depth_m[inside < 0.95] == pytest.approx(10.0, abs=1e-3)
    assert np.isinf(depth_m[inside > 1.05]).all()


def test_colours_must_match_points_and_poses_be_four_by_four(renderer: Make, plain: Scene) -> None:
    drawing = renderer(plain, 64, 48)
    with pytest.raises(ValueError, match=r"one colour per point, got \(4, 4\) and 0 for 1"):
        drawing.target_scene([[0.0, 9.0, 1.0]], [], np.eye(4), 50.0, 50.0, 32.0, 24.0)
    with pytest.raises(ValueError, match=r"got \(3, 3\)"):
        drawing.render(np.eye(3), 50.0, 50.0, 32.0, 24.0)


def test_more_light_makes_a_brighter_picture(renderer: Make, today: Scene) -> None:
    drawing, pose = renderer(today, 160, 120), looking_north(1.65, 0.0)
    dark, usual, bright = (
        drawing.render(pose, 130.0, 130.0, 79.5, 59.5, brightness=light).astype(float) for light in (0.7, 1.0, 1.4)
    )
    assert (dark <= usual).all()
    assert (usual <= bright).all()
    assert dark.mean() < usual.mean() - 10.0
    assert bright.mean() > usual.mean() + 10.0
