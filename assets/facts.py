"""The monuments as plain values for JSON: what the model's nodes carry, and what a page may ask for."""

from typing import Any

from assets.site import LANGUAGE, Monument, Site


def monument_facts(monument: Monument) -> dict[str, Any]:
    """Return one monument; lengths in metres, site frame."""
    return {
        "id": monument.id,
        "name": monument.name[LANGUAGE],
        "names": dict(monument.name),
        "height_m": monument.height_m,
        "base_z_m": monument.base_z_m,
        "footprint_en": [list(corner) for corner in monument.footprint.corners_en_m],
        "evidence": monument.evidence,
        "epochs": list(monument.epochs),
        "source": ", ".join(monument.sources),
    }


def list_monuments(site: Site) -> list[dict[str, Any]]:
    """Return every monument, in the order of the site's file."""
    return [monument_facts(monument) for monument in site.monuments]
