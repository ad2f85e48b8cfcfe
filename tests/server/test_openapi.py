"""The HTTP interface against what its own description allows and forbids: schemathesis, always with the same requests."""

from collections.abc import Iterator
from contextlib import nullcontext, suppress
from typing import Any, Final

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Unsatisfiable
from schemathesis import GenerationMode
from schemathesis.checks import not_a_server_error

from server.access import Access
from server.limits import Limits
from server.log_store import LogStore
from server.web_server import WebServer
from tests.server.serving import rig, serving, token, until

EXAMPLES: Final = 6
"""For each operation, as described and otherwise: a second or so each."""
UNAVAILABLE: Final = (501, 503, 507)
"""What the server says on purpose where it cannot do what would be right: no replays here, no place, not well."""


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebServer]:
    folder = tmp_path_factory.mktemp("openapi")
    store = LogStore(folder / "data", max_bytes=10**6, max_total_bytes=10**7, keep_days=0.0, now_s=lambda: 0.0)
    limits = Limits(requests_per_s=1e6, burst=1e6)
    with serving(folder, store=store, limits=limits, access=Access.with_secret(bytes(32))) as running:
        with rig(running) as walker:  # its session is one of the names that may be renamed
            walker.send('{"type":"state","session":{"kind":"live"}}')
            until(lambda: "walk" in running.app.state.sessions)
        yield running


def operations(server: WebServer) -> list[Any]:
    """Return every operation that the server describes."""
    described = httpx.get(f"{server.url}openapi.json", trust_env=False).json()
    found: list[Any] = list(schemathesis.openapi.from_dict(described).get_all_operations())
    return [result.ok() for result in found]


def answered(server: WebServer, operation: Any, mode: GenerationMode, headers: dict[str, str]) -> set[int]:
    """Try an operation and return the statuses of the answers; none of them is a failure of the server's."""
    statuses = set[int]()

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        database=None,
        deadline=None,
        phases=[Phase.explicit, Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(generation_mode=mode))
    def ask(case: Any) -> None:
        answer = case.call(base_url=server.url.rstrip("/"), headers=headers)
        statuses.add(answer.status_code)
        if answer.status_code not in UNAVAILABLE:
            case.validate_response(answer, checks=[not_a_server_error])
        assert "Traceback" not in answer.text

    # what takes nothing cannot be asked wrongly
    with suppress(Unsatisfiable) if mode is GenerationMode.NEGATIVE else nullcontext():
        ask()
    return statuses


@pytest.mark.parametrize("mode", list(GenerationMode), ids=lambda mode: str(mode.value))
@pytest.mark.parametrize("role", ["admin", None])
def test_no_request_makes_the_server_fail(server: WebServer, mode: GenerationMode, role: Any) -> None:
    headers = {} if role is None else {"Authorization": f"Bearer {token(role)}"}
    tried = {operation.label: answered(server, operation, mode, headers) for operation in operations(server)}
    asked = {name for name, statuses in tried.items() if statuses}
    assert {"PATCH /api/sessions/{name}", "POST /api/sessions"} <= asked
    if role is None:
        guarded = {name: statuses for name, statuses in tried.items() if "/api/logs" in name or "PATCH" in name}
        assert all(statuses <= {401, 404, 405, 413, 422} for statuses in guarded.values()), guarded
    assert httpx.get(f"{server.url}ready", trust_env=False).status_code == 200
