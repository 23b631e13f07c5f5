"""The page of `btq explain` about a node of Nav2: its ports in all distributions side by side."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from textwrap import fill
from typing import Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS, FILES
from btq_lang.catalog.nav2.nodes import NODES
from btq_lang.parser import parse
from btq_lang.syntax.tree import Model, Port, models_in
from btq_lang.workspace.loader import read


def nav2_nodes() -> list[str]:
    """The names of all nodes of Nav2 in any distribution."""
    return sorted({name for distribution in DISTRIBUTIONS for name in models_of(distribution)})


def nav2_page(name: str) -> Iterator[str]:
    """The page of a node, if it is one."""
    models = {
        distribution: models_of(distribution)[name] for distribution in DISTRIBUTIONS if name in models_of(distribution)
    }
    if not models:
        return
    *_, newest = models.values()
    lines = [f"# {name} ({newest.category.raw} of Nav2)", "", newest.text.text if newest.text is not None else "", ""]
    if name in NODES:
        lines += [fill(NODES[name].semantics, 100), ""]
    lines.append(f"in: {', '.join(map(str.capitalize, models))}")
    if rows := _rows(models):
        width = max(map(len, rows))
        lines += ["", f"{'':{width}}  {'  '.join(distribution[0].upper() for distribution in models)}"]
        for port, (has, text) in rows.items():
            marks = "  ".join("x" if distribution in has else "-" for distribution in models)
            lines.append(f"{port:{width}}  {marks}  {text}")
        lines += ["", "An input without a default is one without which the node fails or has nothing to do."]
    yield "\n".join(lines)


def _rows(models: dict[str, Model]) -> dict[str, tuple[list[str], str]]:
    """The ports as they are declared, those of one name together, each with its distributions and its meaning."""
    by_name: dict[str, dict[str, tuple[list[str], str]]] = {}
    for distribution, model in models.items():
        for port in model.ports:
            text = port.text.text if port.text is not None else ""
            declared = by_name.setdefault(port.id.text if port.id is not None else "", {})
            declared.setdefault(_declared(port), ([], text))[0].append(distribution)
    return {port: row for declared in by_name.values() for port, row in declared.items()}


def _declared(port: Port) -> str:
    name = port.id.text if port.id is not None else ""
    default = f" = {port.default.text or _NOTHING}" if port.default is not None else ""
    return f"{port.direction.raw:6} {name} : {port.type.text if port.type is not None else ''}{default}"


@cache
def models_of(distribution: str) -> dict[str, Model]:
    """The models of a distribution's nodes, by name."""
    text, _ = read(FILES[distribution])
    models = (model for entry in parse(text or "").entries for model in models_in(entry.item))
    return {model.name.text: model for model in models if model.name is not None}


_NOTHING: Final = '""'
