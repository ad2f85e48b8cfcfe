"""How Python and OpenCV are set for a live walk, each by a measurement (ARCHITECTURE.md, "Live, as measured")."""

import gc

import cv2


def tune() -> None:
    """Set them, before any thread of the walk starts."""
    cv2.setNumThreads(1)  # vision has one thread; a second for OpenCV would take the core that fusion needs


def settle() -> None:
    """Leave what the program has loaded out of the collection of garbage, once everything is put together.

    A full collection comes every few minutes and stops all threads: for 93 ms with the site's model and the libraries in it, for
    2 ms without them.
    """
    gc.collect()
    gc.freeze()
