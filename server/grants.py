"""Who may do what. A grant is what a token says once its signature has been checked (`server/tokens.py`). Pure."""

from typing import Annotated, Final, Literal

from msgspec import Meta, Struct

Role = Literal["viewer", "rig", "operator", "admin", "local"]
Ability = Literal["watch", "see", "control", "publish", "operate", "administer"]

#: What each role may do; `local` is everybody who reaches a server on loopback, and no token can give it.
ABILITIES: Final[dict[Role, frozenset[Ability]]] = {
    "viewer": frozenset({"watch"}),
    "rig": frozenset({"watch", "see", "control", "publish"}),
    "operator": frozenset({"watch", "control", "operate"}),
    "admin": frozenset({"watch", "control", "operate", "administer"}),
    "local": frozenset({"watch", "see", "control", "operate"}),
}
"""`watch`: state and poses. `see`: the camera picture though the walker does not share it. `control`: pause, seek, share.
`publish`: push as the rig. `operate`: end and rename walks, and recordings. `administer`: hand out codes for other roles."""

SESSION_PATTERN: Final = r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}"
SessionName = Annotated[str, Meta(pattern=rf"\A{SESSION_PATTERN}\Z", max_length=64)]


class Grant(Struct, frozen=True):
    """A role, in one session or in all, until some time."""

    role: Role
    session: SessionName | None = None
    """The one session that it is for; None for all, which a rig never has."""
    t_expires_s: int | None = None
    """Seconds since 1970, UTC; None for never, which only `local` has."""

    def allows(self, ability: Ability, session: str | None = None) -> bool:
        """Whether something may be done: in a session, or with None in the server as a whole."""
        return ability in ABILITIES[self.role] and self.session in (None, session)

    def expired(self, now_s: float) -> bool:
        """Whether its time is over."""
        return self.t_expires_s is not None and now_s >= self.t_expires_s


#: On loopback: same-origin pages have the walker's view.
LOCAL: Final = Grant("local")
