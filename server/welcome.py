"""What the way in says to visitors, in English and in Turkish. Pure; the pages' own texts are in `web/src/language/`."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, Literal, get_args

Language = Literal["en", "tr"]

LANGUAGES: Final[tuple[Language, ...]] = get_args(Language)

#: By what they are for: English, Turkish.
WORDS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "title": ("Agora · enter", "Agora · giriş"),
        "label": ("Token or code", "Anahtar ya da kod"),
        "button": ("Enter", "Gir"),
    }
)
#: Sentences as the server says them in English, in Turkish.
SENTENCES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "Show what its operator gave you.": "Görevlinin size verdiğini gösterin.",
        "This token is not one of this server's: ask its operator for another.": (
            "Bu anahtar bu sunucunun değil: görevliden başka bir tane isteyin."
        ),
        "This token is of another version: ask the server's operator for another.": (
            "Bu anahtar başka bir sürümün: sunucunun görevlisinden başka bir tane isteyin."
        ),
        "This token has expired: ask the server's operator for another.": (
            "Bu anahtarın süresi doldu: sunucunun görevlisinden başka bir tane isteyin."
        ),
        "This code was used already or its time is over: ask for another, or enter with a token.": (
            "Bu kod kullanılmış ya da süresi dolmuş: başka bir tane isteyin ya da bir anahtarla girin."
        ),
    }
)


def language_of(accepted: str | None) -> Language:
    """Return the first language of an Accept-Language header that there is, by its weights; English where none is."""
    best: tuple[float, Language] = (0.0, "en")
    for wish in (accepted or "").split(","):
        name, _, rest = wish.strip().partition(";")
        weight = _weight(rest)
        for language in LANGUAGES:
            if name.strip().lower().split("-")[0] == language and weight > best[0]:
                best = (weight, language)
    return best[1]


def words(language: Language) -> dict[str, str]:
    """Return the form's words in a language."""
    return {name: texts[LANGUAGES.index(language)] for name, texts in WORDS.items()}


def said(sentence: str, language: Language) -> str:
    """Return a sentence of the server's in a language; one that nobody knows stays as it is."""
    return sentence if language == "en" else SENTENCES.get(sentence, sentence)


def _weight(parameters: str) -> float:
    name, _, value = parameters.replace(" ", "").partition("=")
    if name != "q":
        return 1.0
    try:
        return float(value)
    except ValueError:
        return 0.0
