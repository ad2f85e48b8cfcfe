"""A page of a few sentences that needs neither the built pages nor a script: the way in, what is not here, a certificate."""

from base64 import b64encode
from collections.abc import Mapping
from hashlib import sha256
from html import escape
from typing import Final

from fastapi.responses import HTMLResponse

_STYLE: Final = """
:root{color-scheme:dark;--ink:#f6efe2;--quiet:#cdc2ad;--ground:#0b0a08;--line:#6d6455;--fill:#2b251c;--accent:#e3c48f}
@media (prefers-contrast:more){:root{color-scheme:light;
--ink:#000;--quiet:#1c1710;--ground:#fff;--line:#000;--fill:#fff;--accent:#7a3b00}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);
font:1.0625rem/1.5 ui-sans-serif,system-ui,"Segoe UI","Noto Sans","DejaVu Sans",sans-serif}
main{max-width:34rem;margin:0 auto;padding:clamp(1.5rem,12vh,7rem) 1.25rem 3rem}
.brand{margin:0;color:var(--accent);font-weight:650;letter-spacing:.08em;text-transform:uppercase}
h1{margin:.4rem 0 1rem;font:600 1.6rem/1.25 ui-serif,Georgia,"DejaVu Serif",serif;text-wrap:balance}
p,li{text-wrap:pretty}
label{display:block;color:var(--quiet)}
input,button,.go{font:inherit;color:inherit;width:100%;min-height:48px;padding:.4rem .8rem;margin-top:.5rem;
border:1px solid var(--line);border-radius:.5rem;background:var(--fill)}
button,.go{cursor:pointer;border-color:var(--accent);font-weight:600}
.go{display:grid;place-content:center;margin-top:1.5rem;text-decoration:none}
:focus-visible{outline:3px solid var(--accent);outline-offset:2px}
a{color:var(--accent)}
.go{color:var(--ink)}
ol{padding-left:1.4rem}
li{margin:.6rem 0}
code{word-break:break-all}
svg{width:14rem;height:14rem;display:block;margin:1rem 0;background:#fff;border-radius:.4rem}
"""


def plain_page(
    language: str,
    title: str,
    body: str,
    *,
    status: int = 200,
    has_form: bool = False,
    headers: Mapping[str, str] | None = None,
) -> HTMLResponse:
    """Return a page under a policy of its own: one style, told by its hash, and no script at all.

    Args:
        language: Of its texts.
        title: As text.
        body: As HTML, below the project's name.
        status: The response's.
        has_form: Whether it has a form, which comes back here.
        headers: More of them.
    """
    policy = "; ".join(
        (
            "default-src 'none'",
            f"style-src 'sha256-{b64encode(sha256(_STYLE.encode()).digest()).decode()}'",
            "form-action 'self'" if has_form else "form-action 'none'",
            "base-uri 'none'",
            "frame-ancestors 'none'",
        )
    )
    page = (
        f'<!doctype html><html lang="{language}"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style></head>"
        f'<body><main><p class="brand">Agora</p>{body}</main></body></html>'
    )
    return HTMLResponse(
        page, status, {"Content-Security-Policy": policy, "Cache-Control": "no-store"} | dict(headers or {})
    )
