"""The page that brings a local authority's certificate to phones and tablets: a QR code, a file, and what to tap."""

from base64 import b64encode
from collections.abc import Collection
from hashlib import sha256
from html import escape
from time import monotonic
from typing import Final

import segno
from fastapi import APIRouter, FastAPI, Response
from fastapi.responses import HTMLResponse

from server.app import NO_TELEMETRY
from server.guards import Guard
from server.limits import Limits, Throttle, Visitors
from server.local_authority import LocalAuthority, own_names
from server.web_server import WebServer

_STYLE: Final = (
    "body{background:#fff;color:#111;font:1rem/1.5 system-ui,sans-serif;max-width:36rem;margin:2rem auto;padding:0 1rem}"
    "svg{width:14rem;height:14rem;display:block;margin:1rem 0}code{word-break:break-all}"
)
_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        f"style-src 'sha256-{b64encode(sha256(_STYLE.encode()).digest()).decode()}'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
_PAGE: Final = """<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Agora · certificate</title><style>{style}</style><h1>Let this device trust Agora</h1>
<p>Open this page on the phone or tablet: scan the code, or go to <code>{url}</code>.</p>{code}
<ol><li><a href="/agora.crt">Load the certificate</a>.</li>
<li>iPhone, iPad: Settings, <em>Profile Downloaded</em>, Install; then General, About, Certificate Trust Settings: switch it on.
Android: Settings, Security, Encryption &amp; credentials, Install a certificate, CA certificate.</li>
<li>Compare its SHA-256 fingerprint with what the server printed when it was started:<br><code>{fingerprint}</code></li></ol>
<p>It can vouch for this server alone, and the key that could sign more is gone. Remove it when the visit is over.</p></html>"""


class Installer:
    """A server beside the one with TLS, for those that do not trust that one yet."""

    def __init__(self, authority: LocalAuthority, host: str, port: int, allowed_hosts: Collection[str]) -> None:
        """Take the port after the other server's; enter `server` to serve.

        Raises:
            PortInUse: It is taken.
        """
        app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None, telemetry=NO_TELEMETRY)
        app.state.visitors = Visitors(Limits(), monotonic)
        app.add_middleware(Throttle, visitors=app.state.visitors)
        app.add_middleware(Guard, allowed_hosts=allowed_hosts, any_address=True)
        self.server = WebServer(app, host, min(port + 1, 65535) if port else 0)
        self.url = f"http://{address_for_devices(host)}:{self.server.port}/"
        app.include_router(_routes(authority, self.url))


def address_for_devices(host: str) -> str:
    """Return how other devices reach this machine: by the address that it listens on, or by one that it has."""
    if host not in ("", "0.0.0.0", "::"):
        return f"[{host}]" if ":" in host else host
    addresses = sorted(name for name in own_names() if name[0].isdigit() and not name.startswith("127."))
    return next((name for name in addresses if ":" not in name), "127.0.0.1")


def _routes(authority: LocalAuthority, url: str) -> APIRouter:
    router = APIRouter()
    page = _PAGE.format(
        style=_STYLE,
        url=escape(url),
        code=segno.make(url, error="m").svg_inline(border=2, svgclass=None, lineclass=None),
        fingerprint=authority.fingerprint,
    )

    @router.get("/")
    async def install() -> Response:
        return HTMLResponse(page, headers={"Content-Security-Policy": _POLICY, "Cache-Control": "no-store"})

    @router.get("/agora.crt")
    async def certificate() -> Response:
        return Response(authority.authority_der, media_type="application/x-x509-ca-cert")

    return router
