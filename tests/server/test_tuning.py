"""How Python is set for a live walk."""

import gc

from server.tuning import settle


def test_what_is_loaded_is_left_out_of_the_collection() -> None:
    loaded = len(gc.get_objects())
    try:
        settle()
        assert len(gc.get_objects()) < loaded // 10
    finally:
        gc.unfreeze()
