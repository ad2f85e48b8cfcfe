"""`agora token`: a signed, expiring token of a server, printed for whoever is to have it."""

import os
import re
from pathlib import Path
from typing import Annotated, Final, Literal

import typer

from server.grants import SESSION_PATTERN
from tracker.errors import InputError

_UNITS_S: Final = {"m": 60, "h": 3600, "d": 86_400}
#: Whoever holds a token has what it grants until its time is over.
_LONGEST_S: Final = 366 * 86_400


def token(
    role: Annotated[
        Literal["viewer", "rig", "operator", "admin"],
        typer.Argument(
            help="viewer watches, rig pushes its own session and sees its picture, operator ends walks and has recordings, "
            "admin also lets others in."
        ),
    ],
    session: Annotated[
        str | None, typer.Option(help="For this walk alone; a rig's token must name one.", metavar="NAME")
    ] = None,
    valid: Annotated[str, typer.Option("--for", help="How long: 90m, 8h, 30d.", metavar="TIME")] = "8h",
    data: Annotated[
        Path | None,
        typer.Option(help="The server's folder, with its secret.", metavar="DIR", show_default="as configured"),
    ] = None,
) -> None:
    """Make a token for a server that uses the same folder; deleting the secret in there makes all of them void."""
    from server.configuration import read_configuration
    from server.secret_file import secret_of
    from server.tokens import Signer

    if role == "rig" and session is None:
        raise InputError("A rig's token is for one session: name it with --session.")
    if session is not None and not re.fullmatch(SESSION_PATTERN, session):
        raise InputError(
            f"No walk can be named {session!r}: take up to 64 letters, digits, dots, dashes or underscores."
        )
    options = {"data": None if data is None else str(data)}
    signer = Signer(secret_of(read_configuration(None, os.environ, options).data_folder))
    typer.echo(signer.issue(role, int(signer.now_s()) + seconds(valid), session))


def seconds(text: str) -> int:
    """Return a time like 90m, 8h or 30d in seconds.

    Raises:
        InputError: It is no time, or longer than a year.
    """
    match = re.fullmatch(r"([1-9][0-9]{0,5})([mhd])", text)
    if match is None or (time_s := int(match[1]) * _UNITS_S[match[2]]) > _LONGEST_S:
        raise InputError(f"{text!r} is no time that a token can have: write 90m, 8h or 30d, at most 366d.")
    return time_s
