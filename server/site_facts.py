"""What `/api/site` answers: the facts of a site as JSON, with every text in all its languages."""

import re
from hashlib import sha256
from pathlib import Path
from typing import Any

from assets.facts import monument_facts
from assets.site import LANGUAGE, Landmark, Monument, Reading, Site, Stop, View

#: A built model: its name and its level of detail, 0 the finest.
_LEVEL = re.compile(r"(?P<model>[a-z_]+)\.(?P<level>\d)")
#: Files that stand for no model of their own: they are told beside the models.
_BESIDE = ("materials", "occluders", "walkable")
#: How we know a thing, in words for a page: (English, Turkish).
_EVIDENCE_WORDS = {
    "attested": (
        "Attested: found, measured or written down",
        "Belgelenmiş: bulunmuş, ölçülmüş ya da yazılı olarak geçer",
    ),
    "inferred": ("Inferred: follows from what was found", "Çıkarım: bulunanlardan anlaşılır"),
    "hypothetical": (
        "Hypothetical: a guess by the rules of the time",
        "Varsayım: dönemin kurallarına dayanan bir tahmin",
    ),
}


def site_facts(site: Site, models_folder: Path) -> dict[str, Any]:
    """Return everything a page needs to know of a site; lengths in metres, angles in radians, site frame.

    `models` are by name, each with its `levels` (URLs, the finest first); `materials`, `occluders` and `walkable` are
    URLs, or null where they are not built. A model in a single file is its URL.
    """
    return {
        "id": site.id,
        "name": site.name[LANGUAGE],
        "names": dict(site.name),
        "origin": {
            "lat_deg": site.origin.lat_deg,
            "lon_deg": site.origin.lon_deg,
            "h_ellipsoid_m": site.origin.h_ellipsoid_m,
        },
        "models": _models(models_folder),
        **{name: _url(path) if (path := models_folder / f"{name}.glb").is_file() else None for name in _BESIDE},
        "attribution": site.attribution,
        "licence": site.licence,
        "eye_height_m": site.eye_height_m,
        "default_view": _view(site.default_view),
        "tour": [_stop(stop) for stop in site.tour],
        "landmarks": [_landmark(landmark) for landmark in site.landmarks],
        "evidence": {key: {"en": en, "tr": tr} for key, (en, tr) in _EVIDENCE_WORDS.items()},
        "sources": dict(site.sources),
        "monuments": [_monument(monument) for monument in site.monuments],
    }


def _models(folder: Path) -> dict[str, Any]:
    models: dict[str, Any] = {}
    for path in sorted(folder.glob("*.glb")):
        match = _LEVEL.fullmatch(path.stem)
        if match is None:
            if path.stem not in _BESIDE:
                models.setdefault(path.stem, _url(path))
        else:
            model = models.get(match["model"])
            levels = model["levels"] if isinstance(model, dict) else []
            models[match["model"]] = {"levels": [*levels, _url(path)]}
    return models


def _url(path: Path) -> str:
    """Return a model's address, which names its content: who has kept one never keeps it under another's name."""
    return f"/models/{path.name}?v={sha256(path.read_bytes()).hexdigest()[:12]}"


def _view(view: View) -> dict[str, Any]:
    return {
        "id": view.id,
        "name": view.name[LANGUAGE],
        "names": dict(view.name),
        "e_m": view.e_m,
        "n_m": view.n_m,
        "heading_rad": view.heading_rad,
        "pitch_rad": view.pitch_rad,
    }


def _stop(stop: Stop) -> dict[str, Any]:
    return _view(stop) | {"monument": stop.monument, "text": stop.text[LANGUAGE], "texts": dict(stop.text)}


def _landmark(landmark: Landmark) -> dict[str, Any]:
    return {
        "id": landmark.id,
        "name": landmark.name[LANGUAGE],
        "names": dict(landmark.name),
        "monument": landmark.monument,
        "point_site_m": list(landmark.point_m),
    }


def _monument(monument: Monument) -> dict[str, Any]:
    return monument_facts(monument) | {
        "caption": monument.caption[LANGUAGE],
        "captions": dict(monument.caption),
        "caption_status": monument.caption_status,
        "sources": list(monument.sources),
        "variants": [_reading(variant) for variant in monument.variants],
        "default_variant": monument.default_variant,
        "attributions": [_reading(reading) for reading in monument.attributions],
    }


def _reading(reading: Reading) -> dict[str, Any]:
    return {
        "id": reading.id,
        "name": reading.name[LANGUAGE],
        "names": dict(reading.name),
        "why": dict(reading.why),
        "evidence": reading.evidence,
        "sources": list(reading.sources),
    }
