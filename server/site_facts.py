"""What `/api/site` answers: the facts of a site as JSON."""

from pathlib import Path
from typing import Any

from assets.site import Monument, Site

_LANGUAGE = "en"


def site_facts(site: Site, models_folder: Path) -> dict[str, Any]:
    """Return the site's name, origin, models by name (each a URL), credit and monuments; lengths in metres, site frame."""
    return {
        "id": site.id,
        "name": site.name[_LANGUAGE],
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
        "monuments": [_monument(monument) for monument in site.monuments],
    }


def _monument(monument: Monument) -> dict[str, Any]:
    return {
        "id": monument.id,
        "name": monument.name[_LANGUAGE],
        "names": dict(monument.name),
        "caption": monument.caption.get(_LANGUAGE),
        "height_m": monument.height_m,
        "base_z_m": monument.base_z_m,
        "footprint_en": [list(corner) for corner in monument.footprint.corners_en_m],
        "evidence": monument.evidence,
        "epochs": list(monument.epochs),
    }
