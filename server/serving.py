"""A server for many rigs and many viewers, without a walk of its own: what `agora serve` runs."""

import logging
import secrets
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from time import monotonic_ns, time_ns
from types import TracebackType
from typing import Final, Self

from assets.site import Site
from server.access import Access
from server.app import create_app
from server.cluster.bus import LocalBus
from server.cluster.nats_bus import NatsBus
from server.cluster.nats_settings import NatsSettings
from server.cluster.relay import Relay
from server.configuration import Configuration
from server.console.hosting import ConsoleHost, Link
from server.errors import ServerError
from server.grants import Grant
from server.installing import Installer
from server.local_authority import LocalAuthority, own_names
from server.log_store import LogStore
from server.replays import Replays
from server.secret_file import secret_of
from server.sessions import Sessions
from server.site_facts import site_facts
from server.tls import Tls
from server.web_server import WebServer
from tracker.errors import InputError

_logger = logging.getLogger(__name__)


_FIRST_STAY_S: Final = 12 * 3600
_YEAR_S: Final = 366 * 86_400
_MB: Final = 10**6


class Serving:
    """The server, its port bound. Use it as a context manager: leaving it says goodbye to all and frees the port."""

    def __init__(self, configuration: Configuration, site: Site, web: Path) -> None:
        """Put everything together; nothing is served yet but the port is taken.

        Raises:
            PortInUse, AddressUnavailable: The server cannot listen there.
            InputError: The secret cannot be kept, or TLS not be had as it is configured.
        """
        models = site.folder / "built"
        self._stack = ExitStack()
        self._authority = _authority_of(configuration)
        tls = _tls_of(configuration) if self._authority is None else self._authority.tls
        hosts = configuration.hosts if self._authority is None else configuration.hosts | own_names()
        # on loopback too: a proxy may stand there, and behind it everybody
        self._access = Access.with_secret(secret_of(configuration.data_folder))
        sessions = Sessions(monotonic_ns, configuration.max_sessions, configuration.max_viewers)
        store = LogStore(
            configuration.data_folder,
            max_bytes=configuration.max_upload_mb * _MB,
            max_total_bytes=configuration.max_stored_mb * _MB,
            keep_days=configuration.keep_days,
            now_s=lambda: time_ns() * 1e-9,
        )
        replays = Replays(
            sessions,
            store,
            site=site.folder,
            link=self._link,
            most=configuration.max_replays,
            idle_s=configuration.replay_idle_s,
            memory_bytes=configuration.replay_memory_mb * _MB,
            trust=None if tls is None else tls.own_pem(),
        )
        app = create_app(
            web_folder=web,
            models_folder=models,
            site=site_facts(site, models),
            access=self._access,
            limits=configuration.limits,
            allowed_hosts=hosts,
            any_address=not configuration.on_loopback,
            sessions=sessions,
            store=store,
            replays=replays,
            site_folder=site.folder,
            review_memory_bytes=configuration.replay_memory_mb * _MB,
            console=ConsoleHost(site.folder, lambda: self._console_link(tls)),
            relay=_relay_of(configuration, sessions),
        )
        self._server = WebServer(app, configuration.host, configuration.port, tls)
        self._installer = None if self._authority is None else self._beside(self._authority, configuration, hosts)
        t_end_s = int(self._access.signer.now_s()) + _FIRST_STAY_S
        self.first_url = f"{self.url}enter?code={self._access.codes.new(Grant('admin', None, t_end_s))}"
        """Makes whoever opens it first, within ten minutes, an administrator for twelve hours."""

    def _beside(self, authority: LocalAuthority, configuration: Configuration, hosts: frozenset[str]) -> Installer:
        try:
            return Installer(authority, configuration.host, configuration.port, hosts)
        except ServerError:
            self._server.close()
            raise

    @property
    def url(self) -> str:
        """The address of the pages on this machine, ending in a slash."""
        return self._server.url

    def _link(self, session: str) -> tuple[str, str]:
        """Return a session's address for a rig of our own, and its token."""
        signer = self._access.signer
        return self._server.rig_url(session), signer.issue("rig", int(signer.now_s()) + _YEAR_S, session)

    def _console_link(self, tls: Tls | None) -> Link:
        signer = self._access.signer
        token = signer.issue("operator", int(signer.now_s()) + _YEAR_S, None)
        return Link(self.url, token, None if tls is None else tls.own_pem())

    @property
    def how_to_trust(self) -> list[str]:
        """What an operator should know of this server's authority; empty where there is none."""
        if self._authority is None or self._installer is None:
            return []
        return [
            f"Phones and tablets load its certificate from {self._installer.url}",
            f"The certificate's SHA-256 fingerprint is {self._authority.fingerprint}",
            f"Rigs take its file: SSL_CERT_FILE={self._authority.path} agora track --to wss://HOST",
        ]

    def __enter__(self) -> Self:
        self._stack.enter_context(self._server)
        if self._installer is not None:
            self._stack.enter_context(self._installer.server)
        _logger.info("serving", extra={"url": self.url})
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        _logger.info("stopping")
        self._stack.close()
        _logger.info("stopped")


def _relay_of(configuration: Configuration, sessions: Sessions) -> Relay:
    settings = NatsSettings(
        urls=configuration.bus,
        user=configuration.bus_user,
        password_file=configuration.bus_password_file,
        ca=configuration.bus_ca,
        certificate=configuration.bus_cert,
        key=configuration.bus_key,
        replicas=configuration.bus_replicas,
    )
    # a server that is started anew is another one: its rigs come back to it as they would to any
    return Relay(sessions, NatsBus(settings) if configuration.bus else LocalBus(), secrets.token_hex(8))


def _authority_of(configuration: Configuration) -> LocalAuthority | None:
    if not configuration.tls_local:
        return None
    if configuration.tls_cert or configuration.tls_key:
        raise InputError("A server has a given certificate or a local authority's, not both: leave --tls-local out.")
    return LocalAuthority(configuration.data_folder / "tls", configuration.hosts | own_names(), datetime.now(UTC))


def _tls_of(configuration: Configuration) -> Tls | None:
    if bool(configuration.tls_cert) != bool(configuration.tls_key):
        raise InputError("A certificate needs its key, and a key its certificate: give --tls-cert and --tls-key.")
    if not configuration.tls_cert:
        return None
    tls = Tls(Path(configuration.tls_cert).expanduser(), Path(configuration.tls_key).expanduser())
    tls.check()
    return tls
