"""`monuments.toml` read into `Monument` values: one table per monument, by its id."""

import math
from collections.abc import Mapping
from typing import Any, get_args

from assets import brought
from assets.errors import SiteError
from assets.records import (
    KINDS,
    LANGUAGES,
    MODEL,
    PAVING,
    CaptionStatus,
    Confidence,
    Epoch,
    Evidence,
    Figure,
    Footprint,
    ModelFile,
    Monument,
    Order,
    Reading,
    Variant,
)
from assets.table import Table

FURTHEST_M = 5000.0
HIGHEST_M = 500.0


def read_monument(table: Table, monument_id: str, sources: Mapping[str, str]) -> Monument:
    """Return one monument.

    Args:
        table: Its table of `monuments.toml`.
        monument_id: The table's name.
        sources: What each source key of the site stands for; others are refused.

    Raises:
        SiteError: Something is missing or impossible; the sentence names file, key and reason.
    """
    kind = table.choice("kind", KINDS)
    model = _model(table.table("model")) if kind == MODEL else None
    footprint, figures = _shape(table, model, sources)
    _check_heights(table, kind, figures)
    variants = tuple(_variant(t, name, sources) for name, t in _named(table.optional("variants")))
    return Monument(
        id=monument_id,
        name=table.texts("name", LANGUAGES),
        caption=table.texts("caption", LANGUAGES),
        caption_status=table.choice("caption_status", get_args(CaptionStatus)),
        kind=kind,
        order=table.choice("order", get_args(Order)) if "order" in table.values else None,
        epochs=_epochs(table),
        evidence=table.choice("evidence", get_args(Evidence)),
        sources=table.keys("sources", sources),
        footprint=footprint,
        figures=figures,
        stands_on=table.get("stands_on", str) if "stands_on" in table.values else None,
        variants=variants,
        default_variant=_default_variant(table, variants),
        attributions=tuple(Reading(**_reading(t, name, sources)) for name, t in _named(table.optional("attributions"))),
        model=model,
    )


def _named(table: Table) -> list[tuple[str, Table]]:
    return [(name, table.table(name)) for name in table.values]


def _epochs(table: Table) -> tuple[Epoch, ...]:
    epochs = table.get("epochs", list)
    if not all(epoch in get_args(Epoch) for epoch in epochs):
        raise table.refuse("epochs", f"may hold only {', '.join(get_args(Epoch))}")
    return tuple(epochs)


def _shape(table: Table, model: ModelFile | None, sources: Mapping[str, str]) -> tuple[Footprint, dict[str, Figure]]:
    """Footprint and figures; what a brought model does not state is measured on it."""
    stated = table.table("figures") if model is None else table.optional("figures")
    figures = {name: _figure(stated.table(name), sources) for name in stated.values}
    if model is not None:
        source = table.keys("sources", sources)[0]
        measured = brought.measure(model, source, table.path("model.file"), table.file)
        footprint = _footprint(table.table("footprint"), sources) if "footprint" in table.values else measured.footprint
        return footprint, {**measured.figures, **figures}
    for name in ("base_z_m", "height_m"):
        if name not in figures:
            raise SiteError(f"{table.file} has no '{stated.path(name)}'; add it (a figure in metres).")
    return _footprint(table.table("footprint"), sources), figures


def _check_heights(table: Table, kind: str, figures: Mapping[str, Figure]) -> None:
    """Refuse what stands without height, and lengths under zero; levels (`_z_m`) may lie below the paving."""
    for name, figure in figures.items():
        upright = name == "height_m" and kind != PAVING
        wrong = figure.value <= 0.0 if upright else figure.value < 0.0
        if wrong and not name.endswith("_z_m"):
            least = "more than 0" if upright else "0 or more"
            raise table.refuse(f"figures.{name}.value", f"is {figure.value:g}, but must be {least}")


def _figure(table: Table, sources: Mapping[str, str]) -> Figure:
    return Figure(
        value=table.number("value", -FURTHEST_M, FURTHEST_M),
        unit=table.filled("unit"),
        source=_source(table, sources),
        note=table.get("note", str) if "note" in table.values else "",
        confidence=table.choice("confidence", get_args(Confidence)),
        uncertainty=table.number("uncertainty", 0.0, 1000.0),
    )


def _source(table: Table, sources: Mapping[str, str]) -> str:
    source = table.get("source", str)
    if source not in sources:
        raise table.refuse("source", f"is {source!r}, which [sources] of site.toml does not explain")
    return source


def _footprint(table: Table, sources: Mapping[str, str]) -> Footprint:
    return Footprint(
        corners_en_m=table.corners("value"),
        source=_source(table, sources),
        confidence=table.choice("confidence", get_args(Confidence)),
        uncertainty_m=table.number("uncertainty", 0.0, 1000.0),
    )


def _reading(table: Table, reading_id: str, sources: Mapping[str, str]) -> dict[str, Any]:
    return {
        "id": reading_id,
        "name": table.texts("name", LANGUAGES),
        "why": table.texts("why", LANGUAGES),
        "evidence": table.choice("evidence", get_args(Evidence)),
        "sources": table.keys("sources", sources),
    }


def _variant(table: Table, variant_id: str, sources: Mapping[str, str]) -> Variant:
    figures = {name: _figure(t, sources) for name, t in _named(table.optional("figures"))}
    _check_heights(table, "", figures)
    return Variant(**_reading(table, variant_id, sources), figures=figures)


def _default_variant(table: Table, variants: tuple[Variant, ...]) -> str | None:
    if not variants:
        if "default_variant" in table.values:
            raise table.refuse("default_variant", "is given, but there are no variants")
        return None
    name = table.get("default_variant", str)
    if name not in {v.id for v in variants}:
        raise table.refuse("default_variant", f"is {name!r}, not one of {', '.join(v.id for v in variants)}")
    return name


def _model(table: Table) -> ModelFile:
    file = table.file.parent / table.filled("file")
    scale = table.number("scale", 0.0, 1000.0) if "scale" in table.values else 1.0
    if scale == 0.0:
        raise table.refuse("scale", "is 0, but must be more than 0")
    return ModelFile(
        file=file,
        e_m=table.number("e_m", -FURTHEST_M, FURTHEST_M),
        n_m=table.number("n_m", -FURTHEST_M, FURTHEST_M),
        z_m=table.number("z_m", -HIGHEST_M, HIGHEST_M),
        heading_rad=math.radians(table.number("heading_deg", -360.0, 360.0)),
        scale=scale,
    )
