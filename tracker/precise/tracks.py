"""Which features were seen in which of the held pictures, until they are seen no longer."""

import numpy as np
from numpy.typing import NDArray

from tracker.measurements import Matrix, VisualTracks


class Tracks:
    """Features that are being followed. Where one was not seen stands NaN. Arrays are replaced, never changed."""

    def __init__(self, most: int) -> None:
        """A feature that was seen in `most` pictures has told what it can, and begins anew."""
        self._most = most
        self._begin([])

    def _begin(self, stamps: list[int]) -> None:
        self.stamps = stamps
        """Of the K pictures held, in order."""
        self._ids: NDArray[np.int64] = np.zeros(0, np.int64)
        self._xy: Matrix = np.zeros((0, len(stamps), 2))

    def take(self, seen: VisualTracks, t_key_ns: int, t_ns: int, *, is_held: bool) -> Matrix:
        """Take a picture's features, of which those go on that were seen in the one before.

        Args:
            seen: The features.
            t_key_ns: Of the keyframe before, where they were seen as well.
            t_ns: Of this one.
            is_held: Whether the keyframe's pose is held; where it is not, all begins here.

        Returns:
            (M, K, 2): features that go on no longer, where they were seen in the pictures of `stamps`.
        """
        if not is_held or t_key_ns not in self.stamps:
            self._begin([t_key_ns] if is_held else [])
        _, before, now = np.intersect1d(self._ids, seen.ids, assume_unique=True, return_indices=True)
        xy = np.full((len(seen.ids), len(self.stamps) + 1, 2), np.nan)
        if is_held:
            xy[:, self.stamps.index(t_key_ns)] = seen.xy_key
        xy[now, :-1] = self._xy[before]
        xy[:, -1] = seen.xy
        lost = np.delete(self._xy, before, axis=0)
        lost = np.concatenate([lost, np.full((len(lost), 1, 2), np.nan)], axis=1)
        is_full = seen_in(xy).sum(axis=1) >= self._most
        self.stamps = [*self.stamps, t_ns]
        self._ids, self._xy = seen.ids[~is_full], xy[~is_full]
        return np.concatenate([lost, xy[is_full]])

    def forget_oldest(self) -> None:
        """Hold no more pictures than a feature can be seen in."""
        first = max(0, len(self.stamps) - self._most)
        self.stamps, self._xy = self.stamps[first:], self._xy[:, first:]


def seen_in(xy: Matrix) -> NDArray[np.bool_]:
    """Return (M, K) which of (M, K, 2) were seen."""
    return np.asarray(np.isfinite(xy[..., 0]))
