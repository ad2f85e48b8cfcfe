"""What `/api/site` answers: the facts of a site as JSON."""

from pathlib import Path
from typing import Any

from assets.monuments import monument_facts
from assets.site import LANGUAGE, Site


def site_facts(site: Site, models_folder: Path) -> dict[str, Any]:
    """Return the site's name, origin, models by name (each a URL), credit and monuments; lengths in metres, site frame."""
    return {
        "id": site.id,
        "name": site.name[LANGUAGE],
        "names": dict(site.name),
        "origin": {
            "lat_deg": site.origin.lat_deg,
            "lon_deg": site.origin.lon_deg,
            "h_ellipsoid_m": site.origin.h_ellipsoid_m,
        },
        "models": {path.stem: f"/models/{path.name}" for path in sorted(models_folder.glob("*.glb"))},
        "attribution": site.attribution,
        "licence": site.licence,
        "eye_height_m": site.eye_height_m,
        "monuments": [monument_facts(m) | {"caption": m.caption[LANGUAGE]} for m in site.monuments],
    }
