"""Textures painted with numpy: tileable, the same bytes at every run. No file, no camera and no other site stands behind them."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array

Texture: TypeAlias = NDArray[np.uint8]
"""(n, n, 3) blue green red, sRGB."""
SIZE = 512


def noise(seed: int, size: int, coarsest: float, finest: float, slope: float = 1.0) -> Array:
    """Return tileable noise (size, size), mean 0 and deviation 1, between two wave numbers, falling by f**-slope."""
    spectrum = np.fft.rfft2(np.random.default_rng(seed).standard_normal((size, size)))
    wave = np.hypot(np.fft.fftfreq(size)[:, None] * size, np.fft.rfftfreq(size)[None] * size)
    keep = (wave >= coarsest) & (wave <= finest)
    spectrum *= np.where(keep, np.maximum(wave, 1.0) ** -slope, 0.0)
    field: Array = np.fft.irfft2(spectrum, s=(size, size))
    field /= field.std()
    return field


def _mix(low: tuple[int, int, int], high: tuple[int, int, int], share: Array) -> Array:
    """Blend two red green blue colours by `share` (n, n), which is cut to 0..1."""
    s = np.clip(share, 0.0, 1.0)[..., None]
    return np.asarray(low) * (1.0 - s) + np.asarray(high) * s


def _painted(rgb: Array) -> Texture:
    return np.ascontiguousarray(np.clip(rgb, 0.0, 255.0).round().astype(np.uint8)[..., ::-1])


def courses(
    seed: int, rows: int, columns: int, joint_px: float, spread: float, size: int = SIZE
) -> tuple[Array, Array]:
    """A wall of blocks: a tone per block (deviation `spread`), and 0 in the joints rising to 1 inside."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:size, 0:size].astype(np.float64)
    row = (y * rows / size).astype(int)
    shifted = (x * columns / size + (row % 2) * 0.5 + rng.uniform(-0.12, 0.12, rows)[row]) % columns
    column = shifted.astype(int)
    tone = rng.normal(0.0, spread, (rows, columns))[row, column]
    inside_x = np.minimum(shifted % 1.0, 1.0 - shifted % 1.0) * size / columns
    down = y * rows / size % 1.0
    inside_y = np.minimum(down, 1.0 - down) * size / rows
    return tone, np.clip(np.minimum(inside_x, inside_y) / joint_px, 0.0, 1.0)


def marble() -> Texture:
    """White marble, faintly veined with grey."""
    veins = np.clip(1.0 - 6.0 * np.abs(noise(1, SIZE, 2, 30, 1.6)), 0.0, 1.0)
    cloud = noise(2, SIZE, 3, 40, 1.2)
    rgb = _mix((226, 220, 208), (240, 235, 224), 0.5 + 0.3 * cloud)
    return _painted(rgb * (1.0 - 0.09 * veins)[..., None] + 3.0 * noise(3, SIZE, 60, 250, 0.3)[..., None])


def marble_grey() -> Texture:
    """Blue-grey marble, banded."""
    veins = np.clip(1.0 - 4.0 * np.abs(noise(5, SIZE, 2, 40, 1.5)), 0.0, 1.0)
    rgb = _mix((146, 151, 156), (182, 186, 188), 0.5 + 0.24 * noise(6, SIZE, 2, 14, 1.2))
    return _painted(rgb * (1.0 + 0.07 * veins)[..., None] + 3.0 * noise(7, SIZE, 60, 250, 0.3)[..., None])


def granite() -> Texture:
    """Red granite, polished: rose feldspar, grey quartz, dark mica."""
    grains = noise(8, SIZE, 40, 200, 0.2)
    rgb = _mix((150, 92, 84), (196, 146, 132), 0.5 + 0.3 * grains)
    dark = np.clip((noise(9, SIZE, 60, 250, 0.1) - 1.1) * 2.0, 0.0, 0.8)[..., None]
    return _painted(rgb * (1.0 - dark) + np.array((70, 62, 62)) * dark)


def bronze() -> Texture:
    """Bronze with a patina in the hollows."""
    patina = np.clip(0.4 + 0.35 * noise(10, SIZE, 3, 60, 1.0), 0.0, 1.0)[..., None]
    return _painted(_mix((122, 88, 52), (168, 128, 80), 0.5 + 0.3 * noise(14, SIZE, 4, 120, 0.6)) * (1.0 - 0.5 * patina)
                    + np.array((78, 104, 92)) * 0.5 * patina)  # fmt: skip


def panel_edges() -> Array:
    """Return the painted wall's mouldings (n, n): 1 on the frames of its panels, 0 between."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] / SIZE
    left, top = np.minimum(x * 2.0 % 1.0, 1.0 - x * 2.0 % 1.0), np.minimum(np.abs(y - 0.08), np.abs(y - 0.62))
    inside = (y > 0.08) & (y < 0.62)
    upright = np.exp(-(((left - 0.07) / 0.014) ** 2)) * inside
    level = np.exp(-((top / 0.009) ** 2)) * (left > 0.06)
    bands = np.exp(-(((y - 0.70) / 0.008) ** 2)) + np.exp(-(((y - 0.03) / 0.008) ** 2))
    return np.asarray(np.clip(upright + level + bands, 0.0, 1.0))


def painted() -> Texture:
    """Plaster painted in panels: red fields between pale frames, a yellow band, a dark foot."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] / SIZE
    left = np.minimum(x * 2.0 % 1.0, 1.0 - x * 2.0 % 1.0)
    field = ((y > 0.08) & (y < 0.62) & (left > 0.07))[..., None]
    foot = (y > 0.70)[..., None]
    wear = noise(33, SIZE, 2, 60, 0.9)[..., None]
    rgb = np.where(field, (158, 62, 44), (206, 168, 96)) * (1.0 + 0.05 * wear)
    rgb = np.where(foot, np.array((74, 66, 62)) * (1.0 + 0.08 * wear), rgb)
    edge = panel_edges()[..., None]
    bare = np.clip(wear - 1.9, 0.0, 1.0)
    rgb = rgb * (1.0 - edge) + np.array((226, 214, 190)) * edge
    return _painted(rgb * (1.0 - bare) + np.array((214, 200, 172)) * bare)


def ashlar() -> Texture:
    """Marble blocks in courses of half a metre."""
    tone, joint = courses(11, 8, 4, 2.5, 1.0)
    rgb = _mix((196, 186, 168), (232, 224, 208), 0.5 + 0.2 * tone + 0.2 * noise(12, SIZE, 2, 60, 1.0))
    return _painted(rgb * (0.72 + 0.28 * joint)[..., None] + 4.0 * noise(13, SIZE, 40, 250, 0.3)[..., None])


def rustic() -> Texture:
    """Bossed blocks, as in terrace walls."""
    tone, joint = courses(21, 7, 4, 9.0, 1.0)
    rough = noise(22, SIZE, 6, 120, 0.9)
    rgb = _mix((150, 143, 130), (208, 199, 182), 0.5 + 0.22 * tone + 0.22 * rough)
    return _painted(rgb * (0.62 + 0.38 * joint)[..., None])


def plaster() -> Texture:
    """Lime plaster, weathered."""
    rgb = _mix((216, 203, 178), (234, 225, 206), 0.5 + 0.22 * noise(31, SIZE, 1, 30, 1.1))
    return _painted(rgb + 4.0 * noise(32, SIZE, 30, 250, 0.3)[..., None])


PAVING_PX, PAVING_GRID = 1024, (8, 6)
"""Rows and columns of slabs in one repeat."""


def paving() -> Texture:
    """Marble slabs of unequal tone, their middles polished by feet."""
    tone, joint = courses(41, *PAVING_GRID, 3.0, 1.0, PAVING_PX)
    cloud = noise(42, PAVING_PX, 2, 80, 0.9)
    veins = np.clip(1.0 - 5.0 * np.abs(noise(44, PAVING_PX, 3, 60, 1.4)), 0.0, 1.0)[..., None]
    grey = np.clip(0.5 + 0.55 * np.roll(tone, 1, axis=1), 0.0, 1.0)[..., None]
    rgb = _mix((164, 156, 142), (214, 206, 190), 0.5 + 0.26 * tone + 0.2 * cloud)
    rgb = rgb * (1.0 - 0.22 * grey) + np.array((150, 158, 166)) * 0.22 * grey
    fine = noise(43, PAVING_PX, 60, 500, 0.2)[..., None]
    return _painted(rgb * (0.58 + 0.42 * joint)[..., None] * (1.0 - 0.06 * veins) + 5.0 * fine)


TILE_COVERS, TILE_ROWS = 8, 6
"""In one repeat of the roof: cover tiles across, rows of pan tiles down."""


def tiles() -> Texture:
    """Terracotta pan tiles with round cover tiles; down the roof is down the picture."""
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(np.float64)
    across, down = x * TILE_COVERS / SIZE, y * TILE_ROWS / SIZE
    column = np.floor(across + 0.5).astype(int) % TILE_COVERS
    tone = np.random.default_rng(51).normal(0.0, 1.0, (TILE_ROWS, TILE_COVERS))[down.astype(int), column]
    cover = 0.5 + 0.5 * np.cos(2.0 * np.pi * across)
    shade = (0.7 + 0.3 * cover**0.7) * np.clip(0.6 + 4.0 * (1.0 - down % 1.0), 0.0, 1.0)
    rgb = _mix((138, 82, 56), (196, 128, 92), 0.5 + 0.24 * tone + 0.18 * noise(52, SIZE, 4, 80, 0.9))
    lichen = np.clip(noise(53, SIZE, 5, 60, 0.8) - 1.0, 0.0, 1.0)[..., None] * 0.45
    rgb = rgb * (1.0 - lichen) + np.array((150, 140, 112)) * lichen
    return _painted(rgb * shade[..., None])


def grass() -> Texture:
    """Dry summer grass over pale earth, with darker tussocks and small stones."""
    size = 1024
    patches, tussock = noise(61, size, 4, 30, 0.8), noise(62, size, 16, 140, 0.6)
    blades = noise(63, size, 60, 480, 0.15)
    rgb = _mix((150, 134, 106), (214, 200, 168), 0.5 + 0.24 * patches + 0.24 * tussock)
    green = np.clip(0.06 + 0.22 * tussock + 0.12 * patches, 0.0, 0.6)[..., None]
    rgb = rgb * (1.0 - green) + np.array((112, 106, 74)) * green
    pebbles = np.clip((noise(64, size, 40, 160, 0.3) - 2.3) * 2.0, 0.0, 1.0)[..., None]
    return _painted((rgb + 22.0 * blades[..., None]) * (1.0 - pebbles) + np.array((218, 212, 198)) * pebbles)


def earth() -> Texture:
    """Trodden earth and gravel."""
    rgb = _mix((168, 150, 124), (206, 190, 162), 0.5 + 0.22 * noise(71, SIZE, 4, 40, 0.8))
    gravel = np.clip((noise(72, SIZE, 30, 110, 0.3) - 1.4) * 1.5, 0.0, 1.0)[..., None]
    return _painted((rgb + 8.0 * noise(73, SIZE, 40, 250, 0.2)[..., None]) * (1.0 - 0.6 * gravel) + 126.0 * gravel)


def stone() -> Texture:
    """Old marble in the open: grey and ochre lichen, pits and cracks."""
    rgb = _mix((176, 170, 158), (232, 226, 212), 0.5 + 0.3 * noise(81, SIZE, 2, 60, 0.9))
    ochre = np.clip(noise(82, SIZE, 3, 40, 0.9) - 0.9, 0.0, 1.0)[..., None] * 0.6
    rgb = rgb * (1.0 - ochre) + np.array((176, 146, 88)) * ochre
    pits = np.clip((np.abs(noise(83, SIZE, 6, 90, 1.0)) - 0.12) * 5.0, 0.0, 1.0)
    return _painted(rgb * (0.76 + 0.24 * pits)[..., None] + 7.0 * noise(84, SIZE, 50, 250, 0.2)[..., None])


def scrub() -> Texture:
    """A hillside from afar: maquis, dry grass and limestone."""
    bushes = noise(91, SIZE, 8, 90, 0.5)
    rgb = _mix((98, 100, 70), (182, 168, 132), 0.5 - 0.42 * bushes + 0.15 * noise(92, SIZE, 1, 10, 1.0))
    rock = np.clip((noise(93, SIZE, 6, 80, 0.5) - 1.5) * 1.6, 0.0, 1.0)[..., None]
    return _painted(rgb * (1.0 - rock) + np.array((196, 188, 172)) * rock)


def leaves() -> Texture:
    """Foliage in light and shade."""
    rgb = _mix((78, 86, 52), (158, 160, 108), 0.45 + 0.33 * noise(101, SIZE, 12, 160, 0.3))
    return _painted(rgb + 8.0 * noise(102, SIZE, 60, 250, 0.1)[..., None])


def straw() -> Texture:
    """Blades of dry grass."""
    return _painted(_mix((170, 152, 112), (222, 206, 166), 0.5 + 0.3 * noise(105, 128, 2, 50, 0.4)))


def grain() -> Array:
    """Return the grain of boards (n, n): long along the picture's rows."""
    spectrum = np.fft.rfft2(np.random.default_rng(111).standard_normal((SIZE, SIZE)))
    along, across = np.fft.rfftfreq(SIZE)[None] * SIZE, np.fft.fftfreq(SIZE)[:, None] * SIZE
    spectrum *= np.exp(-((along / 6.0) ** 2)) * np.maximum(np.abs(across), 4.0) ** -0.5 * (np.abs(across) < 160)
    field: Array = np.fft.irfft2(spectrum, s=(SIZE, SIZE))
    return np.asarray(field / field.std())


def board_gaps() -> Array:
    """Return 0 in the gaps between boards, rising to 1 on them (n, n)."""
    down = np.arange(SIZE) * 8.0 / SIZE % 1.0
    return np.repeat(np.clip(np.minimum(down, 1.0 - down) * 20.0, 0.0, 1.0)[:, None], SIZE, axis=1)


def wood() -> Texture:
    """Boards of oak."""
    tone = np.repeat(np.random.default_rng(112).normal(0.0, 1.0, 8), SIZE // 8)[:, None]
    rgb = _mix((84, 58, 36), (142, 104, 68), 0.5 + 0.2 * grain() + 0.12 * tone)
    return _painted(rgb * (0.55 + 0.45 * board_gaps())[..., None])


def water() -> Texture:
    """Still water in a basin."""
    return _painted(_mix((62, 92, 96), (126, 156, 154), 0.5 + 0.25 * noise(121, SIZE, 2, 30, 1.2)))
