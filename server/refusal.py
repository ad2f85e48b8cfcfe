"""What stands in the place of a page that there is not, or is not for whoever asks: a page for people, else what programs read."""

from html import escape
from typing import Final

from fastapi import FastAPI, Request
from fastapi.exception_handlers import http_exception_handler
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse, Response

from server.language import Say, language_of, speaking
from server.plain_page import plain_page

_NOT_HERE: Final = "There is nothing at this address. The square is on the start page."


def refusal(headers: Headers, status: int, sentence: str, *, offers_way: bool = False) -> Response:
    """Return a sentence as a page where a browser asks for one, else as plain text.

    Args:
        headers: The request's.
        status: The response's.
        sentence: What is the matter, in English.
        offers_way: Whether the page leads to the square, and to the way in where that may help.
    """
    if not _wants_page(headers):
        return PlainTextResponse(sentence, status)
    language = language_of(headers.get("accept-language"))
    say = speaking(language)
    title = _title(status, say)
    ways = {"/enter": say("Enter")} if status in (401, 403) else {}
    ways["/"] = say("To the square")
    links = "".join(f'<a class="go" href="{path}">{words}</a>' for path, words in ways.items()) if offers_way else ""
    body = f"<h1>{escape(title)}</h1><p>{escape(say(sentence))}</p>{links}"
    return plain_page(language, f"Agora · {title}", body, status=status)


def add_refusals(app: FastAPI) -> None:
    """Answer what the application refuses with such a page, outside `/api/`."""

    @app.exception_handler(HTTPException)
    async def refused(request: Request, exc: HTTPException) -> Response:
        if request.url.path.startswith("/api/") or not _wants_page(request.headers):
            return await http_exception_handler(request, exc)
        say = speaking("en")
        sentences = {
            401: say("This page is for those with a token of this server."),
            403: say("This page is for others than the token that you entered with."),
            404: say(_NOT_HERE),
        }
        otherwise = say("That did not work: try again in a moment.")
        response = refusal(request.headers, exc.status_code, sentences.get(exc.status_code, otherwise), offers_way=True)
        response.headers.update(exc.headers or {})
        return response


def _title(status: int, say: Say) -> str:
    titles = {
        401: say("Not for everyone"),
        403: say("Not for everyone"),
        404: say("Not here"),
        429: say("Too many at once"),
    }
    return titles.get(status, say("Not just now"))


def _wants_page(headers: Headers) -> bool:
    """Whether a browser asks for something to show; its scripts and every program take anything."""
    return "text/html" in headers.get("accept", "")
