"""Pages are written by templates: no HTML in Python, and in templates nothing that is computed."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from jinja2 import Environment, nodes

PACKAGE = Path(__file__).resolve().parents[2] / "btq_lang"
TEMPLATES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.html.j2"))
# `(?P<section>…)` is a group of a regular expression.
TAG = re.compile(
    r"(?<!\?P)</?(?:a|b|body|br|button|caption|code|details|div|em|figcaption|figure|form|h[1-6]|head|header|html|i|input|label|li"
    r"|link|main|meta|nav|ol|option|p|pre|script|section|select|small|span|strong|style|summary|table|tbody|td|tfoot|th"
    r"|thead|title|tr|ul)\b[^<]*>|<!doctype html",
    re.IGNORECASE,
)
# Modules that write such tags, each with the reason.
WRITERS = {
    "btcpp/importing.py": "the engine's Script, which a message names",
    "evidence/compare/markdown.py": "Markdown, in which only HTML folds and ends a line",
    "evidence/markdown.py": "Markdown, in which only HTML ends a line of a table",
    "graph/mermaid.py": "Mermaid, in which only HTML ends a line",
    "graph/svg.py": "SVG, its links, its style sheet and the titles of boxes",
    "prediction/markdown.py": "Markdown, in which only HTML ends a line of a table",
    "render/chart.py": "SVG, the titles of values and marks",
    "simulator/nav2.py": "XML, in a message of Nav2",
    "trace/markdown.py": "Markdown, in which only HTML ends a line of a table",
    "trace/verdicts.py": "SVG, the titles of bars",
}
# What a template may put on the page as it is: drawings and style sheets, made by the writers above.
SAFE = {
    "trace/page.html.j2": {"light", "dark", "each.drawing"},
    "trace/first_screen.html.j2": {"each.drawing"},
    "trace/verdicts.html.j2": {"each.histogram"},
    "evidence/report/page.html.j2": {"each.drawing", "drawing"},
}
FILTERS = {"safe", "code_split", "length", "replace"}
COMPUTED = (nodes.Add, nodes.Sub, nodes.Mul, nodes.Div, nodes.FloorDiv, nodes.Mod, nodes.Pow, nodes.Compare, nodes.Test)


def strings(path: Path) -> str:
    """The texts of a module without docstrings and values, those of f-strings too."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    return "\n".join(
        "…".join(str(part.value) for part in node.values if isinstance(part, ast.Constant))
        if isinstance(node, ast.JoinedStr)
        else str(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.JoinedStr)
        or (isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in alone)
    )


def test_no_html_is_written_in_python() -> None:
    writers = {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py") if TAG.search(strings(path))}
    assert writers == WRITERS.keys()


def parsed(template: str) -> nodes.Template:
    return Environment().parse((PACKAGE / template).read_text(encoding="utf-8"))


def shown(expression: nodes.Expr | None) -> str:
    if isinstance(expression, nodes.Getattr):
        return f"{shown(expression.node)}.{expression.attr}"
    assert isinstance(expression, nodes.Name)
    return expression.name


@pytest.mark.parametrize("template", TEMPLATES)
def test_a_template_computes_nothing(template: str) -> None:
    """It places values: it has conditions and loops, and calls macros, but no arithmetic, comparison or method."""
    tree = parsed(template)
    assert [type(node).__name__ for node in tree.find_all(COMPUTED)] == []
    assert {each.name for each in tree.find_all(nodes.Filter)} <= FILTERS
    called = [call.node for call in tree.find_all(nodes.Call)]
    assert [shown(node) for node in called if not isinstance(node, nodes.Name)] == []


@pytest.mark.parametrize("template", TEMPLATES)
def test_only_drawings_are_not_escaped(template: str) -> None:
    safe = {shown(each.node) for each in parsed(template).find_all(nodes.Filter) if each.name == "safe"}
    assert safe == SAFE.get(template, set())
