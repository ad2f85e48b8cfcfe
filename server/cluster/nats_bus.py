"""A bus over NATS: core subjects for what may be lost, a JetStream key-value bucket for what is kept.

Whichever of NATS's servers goes away, another is found. What is to be sent waits here and not in the client, where newer messages
could not take the place of older ones.
"""

import asyncio
import logging
from collections import OrderedDict, deque
from typing import Final

import nats
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.aio.subscription import Subscription
from nats.js.api import KeyValueConfig, StorageType
from nats.js.errors import BucketNotFoundError, KeyNotFoundError, NoKeysError
from nats.js.kv import KeyValue

from server.cluster.bus import End, Take
from server.cluster.nats_settings import NatsSettings
from server.wire import MAX_FRAME_BYTES

_logger = logging.getLogger(__name__)

_BUCKET: Final = "agora"
#: A session that nobody has told anything of for so long is not kept any more.
_KEPT_S: Final = 24 * 3600.0
_PAUSE_S: Final = 0.2
#: A server of NATS that is silent for about twice this is left.
_PING_S: Final = 1
_CONNECT_S: Final = 2
_KEEP_S: Final = 5.0
#: What may wait in the client on its way out, bytes.
_UNDER_WAY: Final = 4 * 1024 * 1024
_MAX_TOLD: Final = 1000


class _Ear:
    """Somebody who listens to a subject."""

    def __init__(self, subject: str, take: Take) -> None:
        self.subject, self._take = subject, take

    async def hear(self, message: Msg) -> None:
        self._take(message.data)


class NatsBus:
    """See `bus.Bus`."""

    def __init__(self, settings: NatsSettings) -> None:
        """Nothing is connected yet.

        Raises:
            InputError: A file of the settings cannot be read, or the settings do not fit each other.
        """
        self._options, self._replicas = settings.options(), settings.replicas
        self._client: Client | None = None
        self._ears: set[_Ear] = set()
        self._told: deque[tuple[str, bytes]] = deque()
        self._shown: OrderedDict[str, bytes] = OrderedDict()
        self._to_keep: OrderedDict[str, bytes | None] = OrderedDict()
        self._news, self._joined = asyncio.Event(), asyncio.Event()
        self._last_trouble = ""

    @property
    def connected(self) -> bool:
        """See `Bus`."""
        return self._client is not None and self._client.is_connected

    def show(self, subject: str, data: bytes) -> None:
        """See `Bus`."""
        self._shown[subject] = data
        self._news.set()

    def tell(self, subject: str, data: bytes) -> None:
        """See `Bus`."""
        if len(self._told) >= _MAX_TOLD:
            self._told.popleft()
            self._trouble("the bus is away for long: messages are lost")
        self._told.append((subject, data))
        self._news.set()

    def hear(self, subject: str, take: Take) -> End:
        """See `Bus`."""
        ear = _Ear(subject, take)
        self._ears.add(ear)
        self._news.set()

        def end() -> None:
            self._ears.discard(ear)
            self._news.set()

        return end

    def keep(self, key: str, value: bytes | None) -> None:
        """See `Bus`."""
        self._to_keep[key] = value
        self._news.set()

    async def kept(self) -> dict[str, bytes]:
        """See `Bus`."""
        while True:
            await self._joined.wait()
            try:
                if self._client is not None:
                    return await _all(await self._bucket(self._client))
            except (nats.errors.Error, OSError, TimeoutError) as exc:
                self._trouble(f"what the bus keeps cannot be read yet: {exc}")
            await asyncio.sleep(_PAUSE_S)

    async def run(self) -> None:
        """See `Bus`. A connection for good, then another: the client mends what can be mended by itself."""
        while True:
            closed = asyncio.Event()
            client = await self._connect(closed)
            tasks = [asyncio.create_task(self._send(client)), asyncio.create_task(self._keep_all(client))]
            ended = asyncio.create_task(closed.wait())
            self._client = client
            self._joined.set()
            try:
                await asyncio.wait([ended, *tasks], return_when=asyncio.FIRST_COMPLETED)
            finally:
                self._joined.clear()
                for task in (ended, *tasks):
                    task.cancel()
                results = await asyncio.gather(ended, *tasks, return_exceptions=True)
                await client.close()
            for result in results:
                if isinstance(result, Exception):
                    raise result
            await asyncio.sleep(_PAUSE_S)

    # -----------------------------------------------------------------------------------------------------------------

    async def _connect(self, closed: asyncio.Event) -> Client:
        """Return a client that is connected, however long that takes."""

        async def on_error(error: Exception) -> None:
            self._trouble(f"the bus: {error or type(error).__name__}")

        async def on_lost() -> None:
            if not client.is_closed:
                _logger.warning("lost the bus's server: looking for another")

        async def on_back() -> None:
            self._note_joined(client)

        async def on_closed() -> None:
            closed.set()

        while True:
            client = Client()
            try:
                await client.connect(
                    **self._options,
                    name="agora",
                    no_echo=True,
                    connect_timeout=_CONNECT_S,
                    reconnect_time_wait=_PAUSE_S,  # type: ignore[arg-type] # it is only slept for
                    max_reconnect_attempts=-1,
                    ping_interval=_PING_S,
                    max_outstanding_pings=2,
                    error_cb=on_error,
                    disconnected_cb=on_lost,
                    reconnected_cb=on_back,
                    closed_cb=on_closed,
                )
            except (nats.errors.Error, OSError, TimeoutError) as exc:
                self._trouble(f"no server of the bus lets us in: {exc or type(exc).__name__}")
                await client.close()
                await asyncio.sleep(_PAUSE_S)
            else:
                self._note_joined(client)
                return client

    def _note_joined(self, client: Client) -> None:
        url = client.connected_url
        _logger.info("joined the bus", extra={"server": None if url is None else f"{url.hostname}:{url.port}"})
        if client.max_payload < MAX_FRAME_BYTES:
            self._trouble(f"the bus carries messages of {client.max_payload} bytes at most: set max_payload to 8MB")
        self._last_trouble = ""
        self._news.set()

    def _trouble(self, sentence: str) -> None:
        """Say it once, however often it is found."""
        if sentence != self._last_trouble:
            _logger.warning("%s", sentence)
        self._last_trouble = sentence

    async def _send(self, client: Client) -> None:
        """Listen to what is to be listened to, tell what is to be told in its order, then show what is newest."""
        listening: dict[_Ear, Subscription] = {}
        while True:
            await self._news.wait()
            self._news.clear()
            while client.is_connected and (self._told or self._shown or self._ears ^ listening.keys()):
                try:
                    await self._listen(client, listening)
                    await self._send_one(client)
                except (nats.errors.Error, OSError) as exc:
                    self._trouble(f"a message was lost on the bus: {exc or type(exc).__name__}")

    async def _listen(self, client: Client, listening: dict[_Ear, Subscription]) -> None:
        for ear in self._ears - listening.keys():
            listening[ear] = await client.subscribe(ear.subject, cb=ear.hear)
        for ear in listening.keys() - self._ears:
            await listening.pop(ear).unsubscribe()

    async def _send_one(self, client: Client) -> None:
        if self._told:
            await client.publish(*self._told.popleft())
        elif client.pending_data_size > _UNDER_WAY:
            await asyncio.sleep(0.005)
        elif self._shown:
            await client.publish(*self._shown.popitem(last=False))

    async def _keep_all(self, client: Client) -> None:
        while True:
            while self._to_keep:
                key, value = self._to_keep.popitem(last=False)
                try:
                    bucket = await self._bucket(client)
                    await (bucket.delete(key) if value is None else bucket.put(key, value))
                except (nats.errors.Error, OSError, TimeoutError) as exc:
                    self._trouble(f"the bus does not keep what it should, yet: {exc or type(exc).__name__}")
                    self._to_keep.setdefault(key, value)  # a newer one goes before
                    await asyncio.sleep(_PAUSE_S)
            await asyncio.sleep(_PAUSE_S)

    async def _bucket(self, client: Client) -> KeyValue:
        """Return the bucket, made by whoever comes first."""
        context = client.jetstream(timeout=_KEEP_S)
        try:
            return await context.key_value(_BUCKET)
        except BucketNotFoundError:
            wanted = KeyValueConfig(bucket=_BUCKET, ttl=_KEPT_S, storage=StorageType.MEMORY, replicas=self._replicas)
            return await context.create_key_value(wanted)


async def _all(bucket: KeyValue) -> dict[str, bytes]:
    try:
        keys = await bucket.keys()
    except NoKeysError:
        return {}
    found: dict[str, bytes] = {}
    for key in keys:
        try:
            found[key] = (await bucket.get(key)).value or b""
        except KeyNotFoundError:
            continue  # it was ended meanwhile
    return found
