"""A walk and a square of our own making for the tests of the pages: six seconds, drawn pictures, plain volumes."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from heapq import merge
from pathlib import Path

import numpy as np

from assets.gltf import Node, Scene, write_glb
from assets.levels import LEVELS, PAGE_RULES
from assets.materials import MATERIALS
from assets.shape import Place, Shape, footprint_own_m
from assets.site import Monument, Site, load_site
from server.replay import ReplaySettings
from server.showing import Showing
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Image, Measurement, Picture
from tracker.pictures import ArrayPicture, EncodedPicture
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

ROOT = Path(__file__).parents[2]
WEB = ROOT / "web" / "dist"
NAME = "test-walk"
SETTINGS = WalkSettings(seed=2, duration_s=6.0, still_s=2.0, camera_hz=6.0)
BROKEN_FRAME = 20
"""The picture of this one is no JPEG but for its first and last two bytes: the log's reader lets it pass."""
CORNERS = {"top left": (220, 40, 40), "top right": (40, 200, 40), "bottom left": (40, 60, 220)}
"""Red, green, blue of a square in these corners of every picture."""
CORNER_PX = 48
_GREY = 120


def make_walk() -> Walk:
    """Return the walk that every test of the pages sees."""
    return Walk(SETTINGS, default_rig())


def position_of(frame_id: int) -> float:
    """Return a place of the walk where this picture is the newest."""
    return (make_walk().frame_times()[frame_id][1] - START_NS) * 1e-9 + 0.5 / SETTINGS.camera_hz


def frame_at(position_s: float) -> int:
    """Return the picture that is shown at a place of the walk: the last that had arrived."""
    arrived = [t_recv_ns <= START_NS + round(position_s * 1e9) for _, t_recv_ns in make_walk().frame_times()]
    return sum(arrived) - 1


def write_log(path: Path) -> None:
    """Write the walk as a log."""
    walk = make_walk()
    with LogWriter(path, walk.rig, SETTINGS.origin, t_start_ns=START_NS) as writer:
        measurements: list[Iterator[Measurement]] = [simulate(walk), _frames(walk)]
        for measurement in merge(*measurements, key=lambda m: m.t_recv_ns):
            writer.write(measurement)


def _frames(walk: Walk) -> Iterator[Frame]:
    for frame_id, (t_ns, t_recv_ns) in enumerate(walk.frame_times()):
        drawn: Picture = ArrayPicture(_pixels(frame_id))
        broken = EncodedPicture(b"\xff\xd8 and nothing of a JPEG but its ends \xff\xd9")
        yield Frame(t_ns, t_recv_ns, frame_id, broken if frame_id == BROKEN_FRAME else drawn)


def _pixels(frame_id: int) -> Image:
    """Return a grey picture, a little lighter each time, with a colour in each of three corners; blue first."""
    pixels = np.full((480, 640, 3), _GREY + frame_id, np.uint8)
    n = CORNER_PX
    pixels[:n, :n] = CORNERS["top left"][::-1]
    pixels[:n, -n:] = CORNERS["top right"][::-1]
    pixels[-n:, :n] = CORNERS["bottom left"][::-1]
    return pixels


def make_scene(site: Site) -> Scene:
    """Return the square as its paving and one volume on each footprint."""
    ground = Shape()
    ground.polygons(
        "paving", [(-200.0, -150.0, -0.05), (200.0, -150.0, -0.05), (200.0, 150.0, -0.05), (-200.0, 150.0, -0.05)]
    )
    nodes = [Node("ground", ground.meshes(Place.at(0.0, 0.0, 0.0)), {"role": "ground"})]
    for monument in site.shown_in("roman"):
        rivals: list[str | None] = [variant.id for variant in monument.variants] or [None]
        nodes += [_volume(monument, rival) for rival in rivals]
    return Scene(nodes, {name: MATERIALS[name].paint() for name in ("paving", "marble", "tiles")})


def _volume(monument: Monument, rival: str | None) -> Node:
    """Return a monument as a volume; a reconstruction that is not shown at first is half as high."""
    corners = footprint_own_m(monument)
    low = np.column_stack([corners, np.zeros(len(corners))])
    share = 1.0 if rival == monument.default_variant else 0.5
    high = low + np.array([0.0, 0.0, share * monument.height_m])
    shape = Shape()
    shape.polygons("tiles", high)
    shape.polygons("marble", np.stack([low, np.roll(low, -1, 0), np.roll(high, -1, 0), high], axis=1))
    facts = {"role": "building", "monument": monument.id, "evidence": monument.evidence}
    variant = {} if rival is None else {"variant": rival}
    name = monument.id if rival is None else f"{monument.id}/{rival}"
    return Node(name, shape.meshes(Place.of(monument)), facts | variant)


def make_site(folder: Path, occluders: Scene | None = None) -> Site:
    """Return the State Agora with its model, the same at three levels, and what hides it, built into `folder`."""
    site = replace(load_site(ROOT / "assets" / "state_agora"), folder=folder)
    (folder / "built").mkdir()
    for level in LEVELS:
        (folder / "built" / f"roman.{level}.glb").write_bytes(write_glb(make_scene(site), PAGE_RULES))
    if occluders is not None:
        (folder / "built" / "occluders.glb").write_bytes(write_glb(occluders, PAGE_RULES))
    return site


@contextmanager
def showing_walk(folder: Path, occluders: Scene | None = None) -> Iterator[Showing]:
    """Show the walk, by its truth and again and again, on a server of its own."""
    write_log(folder / f"{NAME}.mcap")
    with showing_in(make_site(folder, occluders)) as showing:
        yield showing


@contextmanager
def showing_in(site: Site, port: int = 0) -> Iterator[Showing]:
    """Show the walk that lies in the site's folder."""
    settings = ReplaySettings(estimator="truth", looping=True)
    with Showing(site, Log.open(site.folder / f"{NAME}.mcap"), settings, port=port, web=WEB) as showing:
        yield showing
