"""What the server's own pages say to visitors, in their language. Pure; the other pages' texts are in `web/src/language/`.

A page is written in English, each text of it as `say("...")`; a language is one more file beside this one, named by two letters.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from pkgutil import iter_modules
from types import MappingProxyType
from typing import Final

Say = Callable[[str], str]

CATALOGUES: Final[Mapping[str, Mapping[str, str]]] = MappingProxyType(
    {module.name: import_module(f"{__name__}.{module.name}").TEXTS for module in iter_modules(__path__)}
)
"""By language: every text as the pages have it in English, and what it is there."""
LANGUAGES: Final = ("en", *CATALOGUES)


def language_of(accepted: str | None) -> str:
    """Return the first language of an Accept-Language header that there is, by its weights; English where none is."""
    best = (0.0, "en")
    for wish in (accepted or "").split(","):
        name, _, rest = wish.strip().partition(";")
        weight = _weight(rest)
        for language in LANGUAGES:
            if name.strip().lower().split("-")[0] == language and weight > best[0]:
                best = (weight, language)
    return best[1]


def speaking(language: str) -> Say:
    """Return what says a text in a language; one that nobody has put into it stays as it is."""
    catalogue = CATALOGUES.get(language, {})
    return lambda text: catalogue.get(text, text)


def _weight(parameters: str) -> float:
    name, _, value = parameters.replace(" ", "").partition("=")
    if name != "q":
        return 1.0
    try:
        return float(value)
    except ValueError:
        return 0.0
