"""Watches every page of a browser: none may ask anybody but its own server, nor break the policy that it came with."""

from typing import Any
from urllib.parse import urlsplit

from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, Request

_ASKS_NOBODY = ("blob", "data", "about", "chrome-error")
"""Schemes of addresses behind which no server is."""


class Confinement:
    """What pages did that they must not, since it was last looked at."""

    def __init__(self) -> None:
        self.breaches: list[str] = []

    def over(self, browser: Browser) -> Any:
        """Return a `new_context` whose pages are watched; without service workers, which would answer in a test's place."""
        make = browser.new_context

        def new_context(**options: Any) -> BrowserContext:
            context = make(**{"service_workers": "block"} | options)
            context.on("request", lambda request: self._asked(context, request))
            context.on("console", self._said)
            context.on("page", lambda page: page.on("websocket", lambda socket: self._asked_at(page, socket.url)))
            return context

        return new_context

    def _asked(self, context: BrowserContext, request: Request) -> None:
        if not request.is_navigation_request():
            for page in context.pages[:1]:
                self._asked_at(page, request.url)

    def _asked_at(self, page: Page, url: str) -> None:
        asked, own = urlsplit(url), urlsplit(page.url)
        if asked.scheme not in _ASKS_NOBODY and own.netloc and asked.netloc != own.netloc:
            self.breaches.append(f"{page.url} asked for {url}")

    def _said(self, message: ConsoleMessage) -> None:
        if "Content Security Policy" in message.text:
            self.breaches.append(message.text)
