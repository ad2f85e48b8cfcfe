"""What a server does by itself while it runs: look after its replays and its console, delete walks that are kept no longer, and
keep up with other servers.
"""

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Final

from server.cluster.relay import Relay
from server.console.hosting import ConsoleHost
from server.log_store import LogStore
from server.replays import Replays

_logger = logging.getLogger(__name__)

_EVERY_S: Final = 1.0
_EXPIRE_EVERY: Final = 600


@asynccontextmanager
async def upkeep(
    store: LogStore | None, replays: Replays | None, console: ConsoleHost | None, relay: Relay | None = None
) -> AsyncIterator[None]:
    """Keep up while the context is open; leaving it ends all replays, and the console."""
    tasks = [asyncio.create_task(_keep_up(store, replays, console))]
    if relay is not None:
        tasks.append(asyncio.create_task(_keep_joined(relay)))
    try:
        yield
    finally:
        for task in tasks:
            task.cancel()
            with suppress(asyncio.CancelledError):
                await task
        if replays is not None:
            replays.close()
        if console is not None:
            console.close()


async def _keep_up(store: LogStore | None, replays: Replays | None, console: ConsoleHost | None) -> None:
    turn = 0
    while True:
        try:
            if replays is not None:
                replays.look_after()
            if console is not None:
                console.look_after()
            if store is not None and turn % _EXPIRE_EVERY == 0:
                for name in await asyncio.to_thread(store.expire):
                    _logger.info("a walk was deleted: its time is over", extra={"log": name})
        except Exception:
            _logger.exception("the upkeep failed and goes on")
        turn += 1
        await asyncio.sleep(_EVERY_S)


async def _keep_joined(relay: Relay) -> None:
    while True:
        try:
            await relay.run()
        except Exception:
            _logger.exception("the way to the other servers failed and is tried anew")
        await asyncio.sleep(_EVERY_S)
