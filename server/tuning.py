"""How Python and OpenCV are set for a live walk, each by a measurement (ARCHITECTURE.md, "Live, as measured")."""

import cv2


def tune() -> None:
    """Set them, before any thread of the walk starts."""
    cv2.setNumThreads(1)  # vision has one thread; a second for OpenCV would take the core that fusion needs
