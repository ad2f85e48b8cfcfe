"""A recorded walk as one HTML file that plays without a server: pictures, poses, the square and the page, all inside."""

import json
import re
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from html import escape
from pathlib import Path
from typing import Any, Final

from server.errors import LogRefused
from server.reviewing.pack import unpacked

#: What stands in the file beside pictures, model and scripts: the walk's curves and events.
_BESIDE_BYTES: Final = 2 * 10**6
_BODY = re.compile(r"<body[^>]*>.*</body>", re.DOTALL)
_LOADED = re.compile(r"<script\b[^>]*>.*?</script>|<link\b[^>]*>", re.DOTALL)
_MODEL: Final = "roman"


@dataclass(frozen=True)
class Exporter:
    """A site and the built pages."""

    web_folder: Path
    models_folder: Path
    site_folder: Path
    site: Mapping[str, Any]
    """What `/api/site` answers."""

    def left_for_frames(self, max_mb: int) -> int:
        """Return how many bytes of messages a page of so many megabytes has room for, once everything else is in.

        Raises:
            LogRefused: Pages or models are not built.
        """
        base64 = sum(path.stat().st_size for path in (self._first_paint(), *self._beside().values()))
        others = sum(self._built(name).stat().st_size for name in ("exported.js", "exported.css"))
        return max(1, int(max_mb * 1e6 - others - _BESIDE_BYTES) * 3 // 4 - base64)

    def page(self, name: str, pack: bytes, timeline: bytes, course: bytes | None, thumbnails: bytes | None) -> str:
        """Return the file's text.

        Args:
            name: Of the walk.
            pack: See `pack.packed`.
            timeline: JSON of `timeline.Timeline`.
            course: JSON of `course.Course`; None where the estimator has none.
            thumbnails: JPEG; None for a walk without pictures.

        Raises:
            LogRefused: Pages or models are not built.
        """
        head, messages = unpacked(pack)
        script, style = (self._built(file).read_text("utf-8") for file in ("exported.js", "exported.css"))
        body = _BODY.search(self._built("replay.html").read_text("utf-8"))
        if body is None:
            raise LogRefused(503, "The web pages are not built whole: run `make setup`.")
        walk = {
            "name": name,
            "estimator": head.estimator,
            "duration_s": head.duration_s,
            "utc_offset_s": head.utc_offset_s,
            "positions_s": head.positions_s,
            "site": self._site(),
            "timeline": json.loads(timeline),
            "course": None if course is None else json.loads(course),
            "thumbnails": None if thumbnails is None else _data_url("image/jpeg", thumbnails),
        }
        script = script.replace("</script", r"<\/script")
        frames = "\n".join(map(_base64, messages))
        blocks = (
            f'<script id="walk-facts" type="application/json">{_json(walk)}</script>',
            f'<script id="walk-frames" type="text/plain">{frames}</script>',
            f"<script>{script}</script></body>",
        )
        return "".join(
            (
                '<!doctype html><html lang="en"><head><meta charset="utf-8" />',
                '<meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover" />',
                f'<meta http-equiv="Content-Security-Policy" content="{_policy(script, style)}" />',
                f"<title>{escape(name)} · Agora</title><style>{style}</style></head>",
                _LOADED.sub("", body[0]).removesuffix("</body>"),
                *blocks,
                "</html>\n",
            )
        )

    def _site(self) -> dict[str, Any]:
        """Return the site's facts with the files that they name inside."""
        inside = {name: _file_url(path) for name, path in self._beside().items()}
        models = {_MODEL: {"levels": [_file_url(self._first_paint())]}}
        return {**self.site, "materials": None, "occluders": None, "walkable": None, **inside, "models": models}

    def _first_paint(self) -> Path:
        levels = sorted(self.models_folder.glob(f"{_MODEL}.*.glb"))
        if not levels:
            raise LogRefused(503, "The model of the square is not built: run `agora build`.")
        return levels[-1]

    def _beside(self) -> dict[str, Path]:
        paths = {name: self.models_folder / f"{name}.glb" for name in ("occluders", "walkable")}
        return {name: path for name, path in paths.items() if path.is_file()}

    def _built(self, file: str) -> Path:
        path = self.web_folder / file
        if not path.is_file():
            raise LogRefused(503, "The web pages are not built yet: run `make setup`.")
        return path


def _policy(script: str, style: str) -> str:
    """Return a policy under which the file runs what is in it, and asks for nothing that is not."""
    hashes = (_base64(sha256(text.encode()).digest()) for text in (script, style))
    ours, looks = (f"'sha256-{value}'" for value in hashes)
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src {ours} 'wasm-unsafe-eval'",
            f"style-src {looks}",
            "img-src data: blob:",
            "connect-src data: blob:",
            "worker-src blob:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def _json(value: object) -> str:
    """Return JSON that cannot end the element that it stands in."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _file_url(path: Path) -> str:
    return _data_url("model/gltf-binary", path.read_bytes())


def _data_url(media_type: str, data: bytes) -> str:
    return f"data:{media_type};base64,{_base64(data)}"


def _base64(data: bytes) -> str:
    return b64encode(data).decode("ascii")
