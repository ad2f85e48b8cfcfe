"""The console in a process of its own: whatever it draws, no walk waits for it.

    python -m server.console.process MEMORY_BYTES

reads one line of JSON, a `ConsoleJob`, answers with one, `{"port": …}` or `{"error": …}`, and goes on until its standard input
ends. viser asks nobody who they are, so its port takes nobody but whoever knows the job's secret: the server that started it.
"""

import asyncio
import http
import sys
from collections.abc import Callable
from contextlib import redirect_stdout
from hmac import compare_digest
from io import StringIO
from pathlib import Path
from threading import Thread
from typing import Any, Final

import msgspec

from server.confinement import confine, tell

LONGEST_JOB: Final = 64 * 1024


class ConsoleJob(msgspec.Struct, frozen=True, kw_only=True):
    """Whose walks are watched, and what stands around them."""

    url: str
    """Of the server's pages, ending in a slash."""
    token: str | None
    """An operator's; None where everybody may look."""
    trust: str | None = None
    """The certificate, PEM, that the server must show."""
    site: str
    """Its folder."""
    secret: str
    """What a connection to the console must show: `Authorization: Bearer SECRET`."""


class ConsoleAnswer(msgspec.Struct, frozen=True, omit_defaults=True):
    """Where it listens, on loopback."""

    port: int = 0
    error: str | None = None


def guard_viser(secret: str) -> None:
    """Have viser's server, from now on, turn away every connection that does not show the secret.

    Without it any page that a browser on this machine has open, and any other user, could steer the console: viser has no
    authentication and does not look at the Origin. It has no place for this either, so that its way into `websockets` is taken.
    """
    import websockets.asyncio.server as websockets_server

    serve, wanted = websockets_server.serve, f"Bearer {secret}"

    def guarded(*arguments: Any, process_request: Callable[..., Any], **options: Any) -> Any:
        def check(connection: Any, request: Any) -> Any:
            if not compare_digest(request.headers.get("Authorization", ""), wanted):
                return connection.respond(http.HTTPStatus.FORBIDDEN, "This console is reached by its server alone.\n")
            return process_request(connection, request)

        return serve(*arguments, process_request=check, **options)

    websockets_server.serve = guarded  # type: ignore[assignment, misc]


def _run(job: ConsoleJob) -> None:
    import viser

    from assets.site import load_site
    from server.console.running import Running

    guard_viser(job.secret)
    with redirect_stdout(StringIO()):  # viser prints a panel, and our standard output is for our own lines
        server = viser.ViserServer("127.0.0.1", 0, label="Agora", verbose=False)
    try:
        running = Running(server, load_site(Path(job.site)), job.url, job.token, job.trust)
        tell(ConsoleAnswer(port=server.get_port()))
        asyncio.run(_until_the_end(running.run))
    finally:
        with redirect_stdout(StringIO()):
            server.stop()


async def _until_the_end(run: Callable[[], Any]) -> None:
    """Run until standard input ends: with the server that started us, whatever becomes of that."""
    loop, stop = asyncio.get_running_loop(), asyncio.Event()

    def wait() -> None:
        sys.stdin.buffer.read()
        loop.call_soon_threadsafe(stop.set)

    Thread(target=wait, name="stdin", daemon=True).start()
    tasks = [asyncio.create_task(run()), asyncio.create_task(stop.wait())]
    done, rest = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in rest:
        task.cancel()
    await asyncio.gather(*rest, return_exceptions=True)
    for task in done:
        task.result()


def _main() -> int:
    confine(int(sys.argv[1]))
    try:
        _run(msgspec.json.decode(sys.stdin.buffer.readline(LONGEST_JOB), type=ConsoleJob))
    except Exception as exc:  # the server tells whoever asked for the console
        tell(ConsoleAnswer(error=str(exc) or type(exc).__name__))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main())
