"""Mermaid, which code hosts draw in Markdown files, issues and pull requests.

The format: https://mermaid.js.org/syntax/flowchart.html.  Texts are quoted, with entity codes for what Mermaid would
interpret: quotes, brackets of HTML, `#`, the backtick that begins Markdown, and the backslash of `\\n`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.graph.figure import Figure
from btq_lang.graph.placing import note_lines


def render(figures: Sequence[Figure], direction: str) -> str:
    """Figures as one flow chart, each tree a subgraph of it."""
    side = "TB" if direction == "down" else "LR"
    lines = [f"flowchart {side}"]
    for number, figure in enumerate(figures):
        lines += [f'  subgraph tree{number}["{_escaped(figure.title)}"]', f"    direction {side}"]
        lines += [f"    {line}" for line in _lines(figure, f"t{number}")]
        lines.append("  end")
    lines.append("  classDef quality stroke:#2f7d4f,stroke-dasharray:6 3;")
    lines.append("  classDef requirement stroke:#a8650f;")
    return "\n".join(lines) + "\n"


def _lines(figure: Figure, prefix: str) -> Iterator[str]:
    for number, box in enumerate(figure.boxes):
        name = f"{prefix}n{number}"
        opening, closing = _BRACKETS[box.outline]
        yield f"{name}{opening}{_text((box.title, *box.lines))}{closing}"
        if box.parent is not None:
            yield f"{prefix}n{box.parent} --- {name}"
        for note_number, note in enumerate(box.notes):
            key = f"{name}q{note_number}"
            opening, closing = ("([", "])") if note.kind == "quality" else ("[", "]")
            yield f"{key}{opening}{_text(note_lines(note))}{closing}:::{note.kind}"
            yield f"{name} -.- {key}"


def _text(lines: Sequence[str]) -> str:
    return f'"{"<br/>".join(map(_escaped, lines))}"'


def _escaped(text: str) -> str:
    return "".join(_CODES.get(character, character) for character in text.replace("\n", " "))


_CODES: Final = {'"': "#quot;", "#": "#35;", "<": "#lt;", ">": "#gt;", "&": "#amp;", "`": "#96;", "\\": "#92;"}
_BRACKETS: Final = {
    "control": ("[", "]"),
    "action": ("[", "]"),
    "condition": ("([", "])"),
    "decorator": ("{{", "}}"),
    "subtree": ("[[", "]]"),
    "unknown": ("[", "]"),
}
