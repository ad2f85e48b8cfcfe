"""The server's secret: 32 random bytes in a file that its owner alone can read."""

import os
import secrets
import stat
from pathlib import Path
from typing import Final

from server.tokens import SECRET_BYTES
from tracker.errors import InputError

NAME: Final = "secret"


def secret_of(folder: Path) -> bytes:
    """Return the secret kept in a folder, made where there is none yet.

    Raises:
        InputError: The file cannot be read or made, others can read it, or it is no secret.
    """
    path = folder.expanduser() / NAME
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        _make(path)
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
        with os.fdopen(handle, "rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            secret = file.read(SECRET_BYTES + 1)
    except OSError as exc:
        raise InputError(f"{path} cannot be read or made: {exc.strerror}; choose another folder with --data.") from exc
    if not stat.S_ISREG(mode) or mode & 0o077:
        raise InputError(f"{path} can be read by others: run `chmod 600` on it, or delete it and hand out new tokens.")
    if len(secret) != SECRET_BYTES:
        raise InputError(f"{path} is no secret of {SECRET_BYTES} bytes: delete it and hand out new tokens.")
    return secret


def _make(path: Path) -> None:
    """Write a new secret where there is none: whole under another name first, so that nobody ever reads half of one."""
    if path.exists():
        return
    draft = path.with_name(f".{NAME}-{secrets.token_hex(8)}")
    handle = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(secrets.token_bytes(SECRET_BYTES))
        os.link(draft, path)
    except FileExistsError:
        pass  # another process was first, and its secret is the one
    finally:
        draft.unlink()
