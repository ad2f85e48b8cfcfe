"""Features of real pictures: corners by Shi and Tomasi, followed by Lucas and Kanade on a pyramid, there and back again."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.features import QUALITY, Features, Pixels, View
from tracker.measurements import Frame, Image

#: A feature that comes back this far from where it started was lost on the way.
RETURN_PX = 1.0


@dataclass(frozen=True)
class Klt:
    """A `FeatureSource` that looks at the pixels."""

    def look(self, frame: Frame) -> View:
        """Return the picture in grey.

        Raises:
            MalformedInput: It does not decode.
        """
        gray = frame.picture.gray()
        height, width = gray.shape
        return View(frame.t_ns, frame.frame_id, width, height, gray)

    def follow(self, before: View, after: View, features: Features) -> tuple[Features, NDArray[np.bool_]]:
        """Track features into the next picture, and back again: what does not return is lost."""
        there, found = _flow(before.content, after.content, features.points_px)
        back, found_back = _flow(after.content, before.content, there)
        off_px = np.linalg.norm(back - features.points_px, axis=1)
        right, bottom = after.width_px - 1, after.height_px - 1
        inside = (there[:, 0] >= 0) & (there[:, 1] >= 0) & (there[:, 0] <= right) & (there[:, 1] <= bottom)
        good = np.asarray(found & found_back & (off_px < RETURN_PX) & inside)
        return Features(there[good], features.marks[good]), good

    def detect(self, view: View, kept: Features, wanted: int, apart_px: int) -> Features:
        """Return the strongest corners in the empty parts of a picture."""
        mask = np.full(view.content.shape, 255, np.uint8)
        for x, y in kept.points_px:
            cv2.circle(mask, (round(float(x)), round(float(y))), apart_px, 0, -1)
        found = cv2.goodFeaturesToTrack(view.content, wanted, QUALITY, apart_px, mask=mask, blockSize=5)
        points = np.zeros((0, 2), np.float32) if found is None else found.reshape(-1, 2).astype(np.float32)
        return Features(points, np.zeros((len(points), 0)))


def _flow(gray: Image, onto: Image, points_px: Pixels) -> tuple[Pixels, NDArray[np.bool_]]:
    """Return where points went, (N, 2), and whether they were found, (N,)."""
    if len(points_px) == 0:  # a dark picture has no features, and OpenCV refuses none
        return points_px, np.zeros(0, np.bool_)
    nothing: Any = None
    there, found, _ = cv2.calcOpticalFlowPyrLK(gray, onto, points_px, nothing, winSize=(17, 17), maxLevel=4)
    return np.asarray(there, np.float32), np.asarray(found).ravel() == 1
