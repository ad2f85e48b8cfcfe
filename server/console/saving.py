"""What an operator can save: a picture of the view, the scene as a page, a walk's path as a table."""

from typing import Any, Final

import cv2

from server.console.walk import Walk

_LARGEST_PX: Final = 2000
_RENDER_S: Final = 20.0
_HEAD: Final = "time_s,east_m,north_m,up_m,sigma_m,motion_model"


def picture(client: Any) -> bytes:
    """Return a client's view as PNG; `TimeoutError` where the browser does not answer. Waits for the browser."""
    camera = client.camera
    height_px, width_px = min(camera.image_height, _LARGEST_PX), min(camera.image_width, _LARGEST_PX)
    pixels = client.get_render(height_px, width_px, transport_format="jpeg", timeout=_RENDER_S)
    done, data = cv2.imencode(".png", pixels[..., 2::-1])
    if not done:
        raise ValueError(f"a picture of shape {pixels.shape} does not encode")
    return data.tobytes()


def table(walk: Walk) -> bytes:
    """Return the path that was drawn, as CSV. Pure."""
    rows = (f"{p.t_s:.3f},{p.p_site_m[0]:.3f},{p.p_site_m[1]:.3f},{p.p_site_m[2]:.3f},{p.sigma_m:.3f},{p.motion_model}"
            for p in walk.places)  # fmt: skip
    return "\n".join([_HEAD, *rows, ""]).encode()
