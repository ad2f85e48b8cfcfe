"""`agora serve`: the server alone, for rigs and viewers elsewhere."""

import os
import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from server.options import SITE, WEB, require_built, site_with, stop_asked
from server.terminal import terminal

out = terminal()


def serve(
    config: Annotated[
        Path | None,
        typer.Option(help="A TOML file.", metavar="FILE", show_default="AGORA_CONFIG, ~/.config/agora/server.toml"),
    ] = None,
    host: Annotated[str | None, typer.Option(help="Address to listen on.", show_default="127.0.0.1")] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="0 takes a free one.", show_default="8470")] = None,
    site: Annotated[
        Path | None, typer.Option("--site", help="The folder of the site.", show_default="the State Agora")
    ] = None,
    data: Annotated[Path | None, typer.Option(help="Where uploaded walks are kept.", metavar="DIR")] = None,
    tls_cert: Annotated[Path | None, typer.Option(help="The server's certificate, PEM.", metavar="FILE")] = None,
    tls_key: Annotated[Path | None, typer.Option(help="Its key, PEM.", metavar="FILE")] = None,
    tls_local: Annotated[
        bool | None, typer.Option("--tls-local", help="TLS by an authority of its own, for a network without others.")
    ] = None,
    bus: Annotated[
        list[str] | None,
        typer.Option(
            help="A server of NATS that joins this one to others, tls://HOST:4222; may be repeated.", metavar="URL"
        ),
    ] = None,
    log_format: Annotated[Literal["text", "json"] | None, typer.Option(help="Of the journal.")] = None,
    print_config: Annotated[
        bool, typer.Option("--print-config", help="Print the configuration as a file, explained, and end.")
    ] = False,
) -> None:
    """Serve walks of many rigs to many viewers; ctrl-C ends it.

    Options go before AGORA_PORT and its like in the environment, and those before the file.
    """
    # imported here, so that `agora rules` need not wait for a web server
    from server.configuration import as_toml, read_configuration

    options = {
        "host": host,
        "port": port,
        "site": None if site is None else str(site),
        "data": None if data is None else str(data),
        "tls_cert": None if tls_cert is None else str(tls_cert),
        "tls_key": None if tls_key is None else str(tls_key),
        "tls_local": tls_local,
        "bus": bus or None,
        "log_format": log_format,
    }
    configuration = read_configuration(config, os.environ, options)
    if print_config:
        out.out(as_toml(configuration), end="")
        return
    from server.journal import keep_journal
    from server.serving import Serving

    keep_journal(configuration.log_format, configuration.log_level)
    place = site_with(Path(configuration.site) if configuration.site else SITE, None)
    web = Path(configuration.web) if configuration.web else WEB
    require_built(place, web)
    stop = stop_asked()
    with Serving(configuration, place, web) as serving:
        out.print(f"Agora is at {serving.url}", soft_wrap=True)
        out.print(f"Its operator enters, once and within ten minutes, by {serving.first_url}", soft_wrap=True)
        for line in serving.how_to_trust:
            out.print(line, soft_wrap=True)
        out.print("Everybody else by a token: agora token viewer, agora token rig --session NAME", soft_wrap=True)
        sys.stdout.flush()
        stop.wait()
