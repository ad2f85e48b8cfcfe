"""The page that brings a local authority's certificate to phones and tablets: a QR code, a file, and what to tap."""

from collections.abc import Collection
from html import escape
from time import monotonic

import segno
from fastapi import APIRouter, FastAPI, Request, Response

from server.app import NO_TELEMETRY
from server.guards import Guard
from server.language import language_of, speaking
from server.limits import Limits, Throttle, Visitors
from server.local_authority import LocalAuthority, own_names
from server.plain_page import plain_page
from server.refusal import add_refusals
from server.web_server import WebServer


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
        add_refusals(app)


def address_for_devices(host: str) -> str:
    """Return how other devices reach this machine: by the address that it listens on, or by one that it has."""
    if host not in ("", "0.0.0.0", "::"):
        return f"[{host}]" if ":" in host else host
    addresses = sorted(name for name in own_names() if name[0].isdigit() and not name.startswith("127."))
    return next((name for name in addresses if ":" not in name), "127.0.0.1")


def _routes(authority: LocalAuthority, url: str) -> APIRouter:
    router = APIRouter()
    code = segno.make(url, error="m").svg_inline(border=2, svgclass=None, lineclass=None)

    @router.get("/")
    async def install(request: Request) -> Response:
        language = language_of(request.headers.get("accept-language"))
        return plain_page(language, speaking(language)("Agora · certificate"), _body(language, url, code, authority))

    @router.get("/agora.crt")
    async def certificate() -> Response:
        return Response(authority.authority_der, media_type="application/x-x509-ca-cert")

    return router


def _body(language: str, url: str, code: str, authority: LocalAuthority) -> str:
    say = speaking(language)
    apple = say(
        "iPhone, iPad: Settings, Profile Downloaded, Install; then General, About, Certificate Trust Settings: switch it on."
    )
    android = say("Android: Settings, Security, Encryption & credentials, Install a certificate, CA certificate.")
    compare = say("Compare its SHA-256 fingerprint with what the server printed when it was started:")
    end = say(
        "It can vouch for this server alone, and the key that could sign more is gone. Remove it when the visit is over."
    )
    return (
        f"<h1>{say('Let this device trust Agora')}</h1>"
        f"<p>{say('Open this page on the phone or tablet: scan the code, or go to')} <code>{escape(url)}</code></p>{code}"
        f'<ol><li><a class="go" href="/agora.crt">{say("Load the certificate")}</a></li>'
        f"<li>{escape(apple)}<br>{escape(android)}</li>"
        f"<li>{compare}<br><code>{authority.fingerprint}</code></li></ol><p>{end}</p>"
    )
