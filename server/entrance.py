"""The way in: `/enter` exchanges a one-time code or a token for a cookie, and the address that stays names neither."""

from html import escape
from typing import Annotated, Any, Final
from urllib.parse import parse_qs

from fastapi import APIRouter, Depends, HTTPException, Request, Response
from fastapi.responses import RedirectResponse
from msgspec import Meta, MsgspecError, Struct, json

from server.access import Access, known
from server.codes import LIFETIME_S
from server.errors import ServerFull, TokenRefused
from server.grants import Grant, SessionName
from server.language import language_of, speaking
from server.plain_page import plain_page
from server.tokens import Issued, is_token

#: Under no-referrer browsers send the form with `Origin: null`, which is what a foreign page's would say.
_HEADERS: Final = {"Referrer-Policy": "strict-origin"}


class CodeRequest(Struct, frozen=True, forbid_unknown_fields=True):
    """What an administrator may ask a code for; everybody else gets one for what they have themselves."""

    role: Issued
    session: SessionName | None = None
    hours: Annotated[float, Meta(gt=0.0, le=24.0 * 366)] = 12.0


def entrance_routes(access: Access) -> APIRouter:
    """Return `/enter`, `/leave`, `/api/access` and `/api/codes`."""
    router = APIRouter()

    @router.get("/enter", include_in_schema=False)
    async def enter(request: Request, code: str | None = None) -> Response:
        if code is None:
            return _page(request, "Enter with what this server's operator gave you.")
        return _admit(access, request, code)

    @router.post("/enter", include_in_schema=False)
    async def enter_by_form(request: Request) -> Response:
        fields = parse_qs((await request.body()).decode(errors="replace"), max_num_fields=4)
        return _admit(access, request, fields.get("token", [""])[0].strip())

    @router.post("/leave", include_in_schema=False)
    async def leave(request: Request) -> Response:
        return RedirectResponse("/enter", 303, {"Set-Cookie": access.no_cookie(secure=_secure(request))})

    @router.get("/api/access")
    async def my_access(grant: Annotated[Grant, Depends(known(access))]) -> dict[str, Any]:
        return {"role": grant.role, "session": grant.session, "t_expires_s": grant.t_expires_s}

    @router.post("/api/codes", status_code=201)
    async def new_code(request: Request, grant: Annotated[Grant, Depends(known(access))]) -> dict[str, Any]:
        body = await request.body()
        wanted = _wanted(access, grant, body) if body else grant
        try:
            code = access.codes.new(wanted)
        except ServerFull as exc:
            raise HTTPException(503, str(exc)) from exc
        return {"code": code, "path": f"/enter?code={code}", "lifetime_s": LIFETIME_S}

    return router


def _admit(access: Access, request: Request, shown: str) -> Response:
    """Set the cookie for a token or one-time code, and go on to where its owner wants to be."""
    try:
        grant = access.signer.read(shown) if is_token(shown) else access.codes.redeem(shown)
    except TokenRefused as exc:
        return _page(request, str(exc), 401)
    onwards = "/" if grant.session is None else f"/ar?session={grant.session}"
    cookie = access.cookie_of(grant, secure=_secure(request))
    return RedirectResponse(onwards, 303, {"Set-Cookie": cookie, "Cache-Control": "no-store"})


def _wanted(access: Access, grant: Grant, body: bytes) -> Grant:
    """Return what an administrator asks a code for."""
    if not grant.allows("administer", grant.session):
        raise HTTPException(403, "Only an administrator hands out codes for others: ask without a body for your own.")
    try:
        wanted = json.decode(body, type=CodeRequest)
    except MsgspecError as exc:
        raise HTTPException(422, f"This is no request for a code: {exc}.") from exc
    session = wanted.session if grant.session is None else grant.session
    if wanted.role == "rig" and session is None:
        raise HTTPException(422, "A rig's code is for one session: name it.")
    t_end_s = int(access.signer.now_s() + 3600.0 * wanted.hours)
    return Grant(wanted.role, session, t_end_s if grant.t_expires_s is None else min(t_end_s, grant.t_expires_s))


def _page(request: Request, sentence: str, status: int = 200) -> Response:
    language = language_of(request.headers.get("accept-language"))
    say = speaking(language)
    body = (
        f'<h1>{escape(say(sentence))}</h1><form method="post" action="/enter"><label for="token">{say("Token or code")}</label>'
        '<input id="token" name="token" type="password" autocomplete="off" required autofocus>'
        f"<button>{say('Enter')}</button></form>"
    )
    return plain_page(language, say("Agora · enter"), body, status=status, has_form=True, headers=_HEADERS)


def _secure(request: Request) -> bool:
    return request.url.scheme == "https"
