"""The FastAPI application, put together from what it is given. No globals, no settings read, no thread."""

from collections.abc import Collection, Mapping
from pathlib import Path
from time import monotonic, monotonic_ns
from typing import Any, Final

from fastapi import FastAPI
from fastapi.telemetry import TelemetryConfig
from starlette.types import Scope

from server.access import Access
from server.cluster.relay import Relay
from server.console.bridge import console_routes
from server.console.hosting import ConsoleHost
from server.entrance import entrance_routes
from server.guards import Guard
from server.limits import Limits, Throttle, Visitors
from server.log_routes import log_routes, upload_routes
from server.log_store import LogStore
from server.refusal import add_refusals
from server.replays import Replays
from server.reviewing.exported import Exporter
from server.reviewing.reviews import Reviews
from server.reviewing.routes import review_routes
from server.routes import Bundle, api_routes, page_routes
from server.session_routes import session_routes
from server.sessions import Sessions
from server.sockets import socket_routes
from server.upkeep import upkeep

LOOPBACK_HOSTS = ("127.0.0.1", "localhost", "::1")
#: FastAPI would export traces where its environment variables say so; nothing but loopback is ever contacted.
NO_TELEMETRY: Final[TelemetryConfig] = {
    "tracing": False,
    "metrics": False,
    "logs": False,
    "operation_spans": False,
    "auto_configure": False,
}


def create_app(
    *,
    web_folder: Path,
    models_folder: Path,
    site: Mapping[str, Any],
    access: Access,
    limits: Limits | None = None,
    allowed_hosts: Collection[str] = LOOPBACK_HOSTS,
    any_address: bool = False,
    console: ConsoleHost | None = None,
    logs: Mapping[str, Path] | None = None,
    sessions: Sessions | None = None,
    store: LogStore | None = None,
    replays: Replays | None = None,
    site_folder: Path | None = None,
    review_memory_bytes: int = 4 * 10**9,
    relay: Relay | None = None,
) -> FastAPI:
    """Return the server's application; `app.state` has its `sessions`, its `access`, and its `visitors` for the door.

    Args:
        web_folder: The built pages (`web/dist`); where they are missing the pages say so.
        models_folder: Where the `*.glb` of `/models/` lie.
        site: What `/api/site` answers, see `server/site_facts.py`.
        access: Who may do what.
        limits: How much one address may ask; None for the usual.
        allowed_hosts: Names in the Host header that are us.
        any_address: Whether an IP address there is taken for ours as well: where the server is bound to all of them.
        console: The operators', at `/console`; None for none.
        logs: The recorded walks that `/api/logs` offers, by session name.
        sessions: The server's; None for fresh ones.
        store: Where uploaded walks are kept, in the place of `logs`.
        replays: Of the walks in the store.
        site_folder: The site's own, for what replays' pages show beside the pictures; None for none of that.
        review_memory_bytes: Of each process that reads a walk for that.
        relay: Joins `sessions` to those of other servers.
    """
    sessions = sessions or Sessions(monotonic_ns)
    # The interactive documentation loads its scripts from elsewhere, so there is none; /openapi.json stays.
    app = FastAPI(
        title="Agora",
        docs_url=None,
        redoc_url=None,
        telemetry=NO_TELEMETRY,
        lifespan=lambda app: upkeep(store, replays, console, relay),
    )
    app.state.sessions, app.state.access = sessions, access
    app.state.visitors = Visitors(limits or Limits(), monotonic)
    app.include_router(api_routes(sessions, site, web_folder, access, alone=store is not None, relay=relay))
    app.include_router(session_routes(sessions, access, replays))
    app.include_router(log_routes(logs or {} if store is None else store, access))
    if store is not None:
        app.include_router(upload_routes(store, access, lambda name: _end_replays(replays, name)))
    if site_folder is not None:
        exporter = Exporter(web_folder, models_folder, site_folder, site)
        reviews = Reviews(review_memory_bytes, lambda: sessions.stopping)
        log_of = (logs or {}).get if replays is None else replays.log_of
        app.include_router(review_routes(sessions, access, reviews, exporter, log_of))
    app.include_router(entrance_routes(access))
    app.include_router(page_routes(web_folder, models_folder))
    app.include_router(console_routes(console, access))
    app.include_router(socket_routes(sessions, access))
    add_refusals(app)
    app.mount("/", Bundle(directory=web_folder, check_dir=False), name="bundle")
    app.add_middleware(Throttle, visitors=app.state.visitors, large_bodies=_is_upload)
    app.add_middleware(Guard, allowed_hosts=allowed_hosts, any_address=any_address)
    return app


def _end_replays(replays: Replays | None, log: str) -> None:
    if replays is not None:
        replays.stop_all_of(log, "The walk was deleted.")


def _is_upload(scope: Scope) -> bool:
    """Whether a request brings a walk: its route has a limit of its own."""
    return bool(scope["method"] == "PUT" and scope["path"].startswith("/api/logs/"))
