"""What is refused: a page in one's language for who looks, and JSON or plain text for programs, as before."""

from pathlib import Path

import httpx
import pytest

from server.access import Access
from tests.server.serving import serving

BROWSER = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8", "Accept-Language": "tr-TR,tr;q=0.9"}


@pytest.mark.parametrize("path", ["/nothing", "/models/nothing.glb", "/assets/nothing.js"])
def test_what_is_not_there_is_a_page_for_people_alone(tmp_path: Path, path: str) -> None:
    with serving(tmp_path) as server, httpx.Client(base_url=server.url) as client:
        page = client.get(path, headers=BROWSER)
        assert page.status_code == 404
        assert "<h1>Burada yok</h1>" in page.text
        assert 'href="/"' in page.text
        assert "script-src" not in page.headers["content-security-policy"]
        assert client.get(path).json() == {"detail": "Not Found"}
        assert client.get("/api/nothing", headers=BROWSER).json() == {"detail": "Not Found"}


def test_who_may_not_see_a_page_is_told_so_and_shown_the_way_in(tmp_path: Path) -> None:
    strict = Access.with_secret(b"s" * 32)
    with serving(tmp_path, access=strict) as server, httpx.Client(base_url=server.url) as client:
        page = client.get("/console", headers=BROWSER)
        assert page.status_code == 401
        assert page.headers["www-authenticate"] == "Bearer"
        assert 'href="/enter"' in page.text
        assert client.get("/console").json()["detail"].startswith("This server asks for a token")


def test_another_name_is_refused_in_words(tmp_path: Path) -> None:
    with serving(tmp_path) as server, httpx.Client(base_url=server.url) as client:
        page = client.get("/", headers=BROWSER | {"Host": "evil.example"})
        assert (page.status_code, page.text.count("Bu sunucunun adı bu değil")) == (403, 1)
        plain = client.get("/", headers={"Host": "evil.example"})
        assert plain.headers["content-type"].startswith("text/plain")
