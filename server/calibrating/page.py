"""The page that shows, while the board is being shown to the camera, what is covered and what to do next. On loopback only."""

from html import escape
from typing import Any, Final

from fastapi import FastAPI, Request, Response
from fastapi.responses import HTMLResponse

from server.app import LOOPBACK_HOSTS
from server.calibrating.lens_run import Collection
from server.guards import Guard
from server.language import language_of, speaking

_NEVER_KEEP: Final = {"Cache-Control": "no-store"}

_STYLE: Final = """
:root { color-scheme: dark; --ink: #e9e6df; --faint: #a0a8b0; --paper: #15181b; --line: #363c42; --good: #58b27c; }
@media (prefers-contrast: more) {
  :root { color-scheme: light; --ink: #000; --faint: #333; --paper: #fff; --line: #000; --good: #00602a; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", Roboto, sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 1.5rem 1.25rem; }
h1 { font-size: 1.05rem; margin: 0; color: var(--faint); font-weight: 600; }
#hint { font-size: 1.5rem; line-height: 1.25; min-height: 2.5em; margin: .3rem 0 .8rem; text-wrap: balance; }
#view { position: relative; background: #000; border: 1px solid var(--line); border-radius: 6px; }
#view { overflow: hidden; min-height: 12rem; }
#view.seen { border-color: var(--good); }
#picture { display: block; width: 100%; }
#grid { position: absolute; inset: 0; display: grid; }
#grid i { border: 1px solid rgb(255 255 255 / 12%); background: rgb(88 178 124 / calc(var(--full) * 34%)); }
dl { display: grid; grid-template-columns: repeat(3, 1fr); gap: .5rem 1.5rem; margin: 1rem 0; }
dt { color: var(--faint); font-size: .9rem; }
dd { margin: 0; font-variant-numeric: tabular-nums; }
meter { width: 60%; height: .9rem; vertical-align: middle; }
.faint { color: var(--faint); font-size: .9rem; margin: 0; }
@media (max-width: 36rem) { dl { grid-template-columns: 1fr; } #hint { font-size: 1.2rem; } }
"""

_SCRIPT: Final = """
"use strict";
const by = (id) => document.getElementById(id);
function meter(id, share, text) { by(id).value = Math.min(1, share); by(id + "-text").textContent = text; }
function showGrid(grid) {
  const cells = grid.flat();
  const box = by("grid");
  if (box.childElementCount !== cells.length) {
    box.style.gridTemplate = `repeat(${grid.length}, 1fr) / repeat(${grid[0].length}, 1fr)`;
    box.replaceChildren(...cells.map(() => document.createElement("i")));
  }
  cells.forEach((count, i) => box.children[i].style.setProperty("--full", Math.min(1, count / 3)));
}
const { ended, of, percent } = document.querySelector("main").dataset;
const count = (text, value, wanted) => text.replace("{count}", value).replace("{wanted}", wanted);
let last = -1;
async function look() {
  let wait = 200;
  try {
    const state = await (await fetch("/state.json")).json();
    by("hint").textContent = state.hint;
    by("view").classList.toggle("seen", state.board_seen);
    meter("coverage", state.coverage / state.coverage_wanted, percent.replace("{percent}", Math.round(100 * state.coverage)));
    meter("views", state.views / state.views_wanted, count(of, state.views, state.views_wanted));
    meter("slanted", state.slanted / state.slanted_wanted, count(of, state.slanted, state.slanted_wanted));
    showGrid(state.grid);
    if (state.pictures !== last && state.pictures) { last = state.pictures; by("picture").src = `/picture.jpg?${last}`; }
    if (state.finished) wait = 2000;
  } catch {
    by("hint").textContent = ended;
    wait = 2000;
  }
  setTimeout(look, wait);
}
look();
"""


def _page(language: str) -> str:
    say = speaking(language)
    meters = {"coverage": say("Covered"), "views": say("Different views"), "slanted": say("Slanted")}
    rows = "".join(
        f'<div><dt id="{name}-name">{words}</dt><dd><meter id="{name}" aria-labelledby="{name}-name" min="0" max="1"></meter> '
        f'<span id="{name}-text"></span></dd></div>'
        for name, words in meters.items()
    )
    note = say(
        "Orange dots are corners that were found; green fills where enough were seen. In the terminal ctrl-C ends it."
    )
    seen = escape(say("What the camera sees, with the board's corners marked"))
    told = {
        "ended": say("The program has ended; its last words are in the terminal."),
        "of": say("{count} of {wanted}"),
        "percent": say("{percent} %"),
    }
    data = " ".join(f'data-{name}="{escape(text)}"' for name, text in told.items())
    return (
        f'<!doctype html><html lang="{language}"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{say('Agora: calibrating the camera')}</title>"
        '<link rel="icon" href="data:,"><link rel="stylesheet" href="/calibrate.css"></head>'
        f"<body><main {data}><h1>{say('Calibrating the camera')}</h1>"
        f'<p id="hint" role="status" aria-live="polite">{say("Waiting for the first picture …")}</p><div id="view">'
        f'<img id="picture" alt="{seen}">'
        f'<div id="grid" aria-hidden="true"></div></div><dl>{rows}</dl><p class="faint">{note}</p></main>'
        '<script src="/calibrate.js"></script></body></html>'
    )


def coverage_app(collection: Collection) -> FastAPI:
    """Return the page's application; it reads the collection while another thread adds to it."""
    app = FastAPI(title="Agora calibrate", docs_url=None, redoc_url=None, openapi_url=None)

    @app.get("/", response_class=HTMLResponse)
    def page(request: Request) -> HTMLResponse:
        return HTMLResponse(_page(language_of(request.headers.get("accept-language"))), headers=_NEVER_KEEP)

    @app.get("/calibrate.css")
    def style() -> Response:
        return Response(_STYLE, media_type="text/css", headers=_NEVER_KEEP)

    @app.get("/calibrate.js")
    def script() -> Response:
        return Response(_SCRIPT, media_type="text/javascript", headers=_NEVER_KEEP)

    @app.get("/state.json")
    def state(request: Request) -> dict[str, Any]:
        return dict(collection.state(speaking(language_of(request.headers.get("accept-language")))))

    @app.get("/picture.jpg")
    def picture() -> Response:
        data = collection.picture()
        return (
            Response(status_code=204) if data is None else Response(data, media_type="image/jpeg", headers=_NEVER_KEEP)
        )

    app.add_middleware(Guard, allowed_hosts=LOOPBACK_HOSTS)
    return app
