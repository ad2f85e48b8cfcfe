"""Who is asking: the grant behind a request's token or cookie, and the dependency that routes guard themselves with. No routes."""

import secrets
from collections.abc import Awaitable, Callable
from http.cookies import CookieError, SimpleCookie
from time import monotonic
from typing import Final, Self

from fastapi import HTTPException, Request
from starlette.datastructures import Headers

from server.codes import Codes
from server.errors import TokenRefused
from server.grants import LOCAL, Ability, Grant
from server.tokens import SECRET_BYTES, Signer

_SCHEME: Final = "bearer "
#: Nobody stays in for longer without showing a token again.
_LONGEST_STAY_S: Final = 30 * 24 * 3600


class Access:
    """What a server knows of tokens, cookies and one-time codes."""

    def __init__(self, signer: Signer, codes: Codes, anonymous: Grant | None = None) -> None:
        """`anonymous` is what those have who show nothing: None lets nobody in."""
        self.signer, self.codes, self.anonymous = signer, codes, anonymous
        # cookies do not tell ports apart: two servers on one machine must not take each other's away
        self.cookie = f"agora-{signer.tag('cookie')}"

    @classmethod
    def with_secret(cls, secret: bytes, anonymous: Grant | None = None) -> Self:
        """Return the access to a server with a secret, by this machine's clocks."""
        return cls(Signer(secret), Codes(monotonic), anonymous)

    @classmethod
    def for_loopback(cls) -> Self:
        """Return the access to a server that only this machine can reach: everybody there has the walker's view."""
        return cls.with_secret(secrets.token_bytes(SECRET_BYTES), LOCAL)

    def grant_of(self, headers: Headers) -> Grant:
        """Return what a request's `Authorization: Bearer TOKEN` grants, else its cookie, else what everybody has.

        Raises:
            TokenRefused: What it shows is not valid, or it shows nothing and must.
        """
        if (authorization := headers.get("authorization")) is not None:
            return self._bearer(authorization)
        if (kept := self._kept(headers)) is not None:
            return self.signer.read(kept)
        if self.anonymous is None:
            raise TokenRefused("This server asks for a token: enter with one at /enter.")
        return self.anonymous

    def rig_of(self, headers: Headers) -> Grant:
        """Return what a rig's header grants; a cookie does not count, so that no web page can ever push.

        Raises:
            TokenRefused: There is no valid token.
        """
        if (authorization := headers.get("authorization")) is None:
            raise TokenRefused("A rig needs a token of this server: see `agora token rig`.")
        return self._bearer(authorization)

    def allows(self, headers: Headers, ability: Ability) -> bool:
        """Whether whoever asks may do something in the server as a whole; nothing valid to show is no error here."""
        try:
            return self.grant_of(headers).allows(ability)
        except TokenRefused:
            return False

    def left_s(self, grant: Grant) -> float | None:
        """Return how long a grant still lasts, seconds; None for ever."""
        return None if grant.t_expires_s is None else max(0.0, grant.t_expires_s - self.signer.now_s())

    def cookie_of(self, grant: Grant, *, secure: bool) -> str:
        """Return the `Set-Cookie` that keeps a grant in a browser: for its own pages alone, and out of their scripts' reach."""
        now_s = int(self.signer.now_s())
        stay_s = min(_LONGEST_STAY_S, (grant.t_expires_s or now_s + _LONGEST_STAY_S) - now_s)
        if grant.role == "local":
            raise ValueError("what everybody has needs no cookie")
        return self._set_cookie(self.signer.issue(grant.role, now_s + stay_s, grant.session), stay_s, secure=secure)

    def no_cookie(self, *, secure: bool) -> str:
        """Return the `Set-Cookie` that takes it away again."""
        return self._set_cookie("", 0, secure=secure)

    def _set_cookie(self, value: str, stay_s: int, *, secure: bool) -> str:
        end = "; Secure" if secure else ""
        return f"{self.cookie}={value}; Max-Age={stay_s}; Path=/; HttpOnly; SameSite=Strict{end}"

    def _bearer(self, authorization: str) -> Grant:
        if not authorization.lower().startswith(_SCHEME):
            raise TokenRefused("Expected `Authorization: Bearer TOKEN`.")
        return self.signer.read(authorization[len(_SCHEME) :].strip())

    def _kept(self, headers: Headers) -> str | None:
        try:
            cookies = SimpleCookie(headers.get("cookie", ""))
        except CookieError:
            return None
        morsel = cookies.get(self.cookie)
        return None if morsel is None else morsel.value


def known(access: Access) -> Callable[[Request], Awaitable[Grant]]:
    """Return the FastAPI dependency that lets in whoever shows something valid, and gives its grant."""

    async def guard(request: Request) -> Grant:
        try:
            return access.grant_of(request.headers)
        except TokenRefused as exc:
            raise HTTPException(401, str(exc), {"WWW-Authenticate": "Bearer"}) from exc

    return guard


def needs(access: Access, ability: Ability, path_parameter: str | None = None) -> Callable[[Request], Awaitable[Grant]]:
    """Return the FastAPI dependency that lets in whoever may do something, and gives its grant.

    Args:
        access: Of this server.
        ability: What the route does.
        path_parameter: The parameter of the path that names the session; None for what concerns the whole server.
    """
    knows = known(access)

    async def guard(request: Request) -> Grant:
        grant = await knows(request)
        session = None if path_parameter is None else request.path_params[path_parameter]
        if not grant.allows(ability, session):
            raise HTTPException(403, f"This token is not for that: it is for {_whose(grant)}.")
        return grant

    return guard


def _whose(grant: Grant) -> str:
    who = f"{'an' if grant.role[0] in 'ao' else 'a'} {grant.role}"
    return who if grant.session is None else f"{who} of {grant.session!r}"
