"""DOT, the language of Graphviz.

One invariant: children are drawn in their order (`ordering=out`).  The format: https://graphviz.org/doc/info/lang.html
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.graph.figure import Figure, Note
from btq_lang.graph.placing import note_lines


def render(figures: Sequence[Figure], direction: str) -> str:
    """Figures as one graph, each tree a cluster of it."""
    lines = [
        "digraph mission {",
        f"  graph [rankdir={'TB' if direction == 'down' else 'LR'}, ordering=out, fontname=Helvetica];",
        "  node [fontname=Helvetica, fontsize=12];",
        "  edge [arrowhead=none];",
    ]
    for number, figure in enumerate(figures):
        lines += [f"  subgraph cluster_{number} {{", f"    label={_quoted(figure.title)};"]
        lines += [f"    {line}" for line in _lines(figure)]
        lines.append("  }")
    return "\n".join((*lines, "}")) + "\n"


def _lines(figure: Figure) -> Iterator[str]:
    for box in figure.boxes:
        yield _node(box.key, _text((box.title, *box.lines)), _SHAPES[box.outline], box.text)
        if box.parent is not None:
            yield f"{_quoted(figure.boxes[box.parent].key)} -> {_quoted(box.key)};"
        for number, note in enumerate(box.notes):
            key = f"{box.key}.{number}"
            yield _node(key, _text(note_lines(note)), _note_shape(note), note.text)
            yield f"{_quoted(box.key)} -> {_quoted(key)} [style=dashed];"


def _node(key: str, text: str, shape: str, tooltip: str) -> str:
    return f"{_quoted(key)} [label={text}, {shape}, tooltip={_quoted(tooltip)}];"


def _note_shape(note: Note) -> str:
    if note.kind == "quality":
        return 'shape=box, style="rounded,dashed", color="#2f7d4f", fontsize=10'
    width = ", penwidth=2" if note.state == "enforced" else ""
    return f'shape=note, color="#a8650f", fontsize=10{width}'


def _text(lines: Sequence[str]) -> str:
    return '"' + "\\n".join(map(_escaped, lines)) + '"'


def _quoted(text: str) -> str:
    return f'"{_escaped(text)}"'


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


_SHAPES: Final = {
    "control": "shape=box",
    "action": "shape=box",
    "condition": "shape=ellipse",
    "decorator": "shape=hexagon",
    "subtree": "shape=box, peripheries=2",
    "unknown": "shape=box, style=dashed",
}
