"""What a built-in node is, code asks of its row in the catalog: outside of it, nothing knows a node by its name."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.nodes import BUILTINS, spellings

ROOT = Path(__file__).parents[2] / "btq_lang"

NAMING = {
    "btcpp/enforcement.py": "writes these",
    "btcpp/guards.py": "writes these",
    "btcpp/wrappers.py": "writes these, and says which nodes enforce clauses",
    "grammar/node_mistakes.py": "writes one for `!Dark`",
    "simulator/kinds.py": "has a function for each",
    "ide/refactor.py": "offers nodes to put around another one, and writes them",
}


def test_no_other_module_names_a_node() -> None:
    names = {word for kind in BUILTINS.values() for word in spellings(kind) if word.isidentifier()} - {*CATEGORIES}
    found: dict[str, set[str]] = {}
    for path in ROOT.rglob("*.py"):
        module = path.relative_to(ROOT).as_posix()
        if not module.startswith("catalog/") and (named := names.intersection(strings(path))):
            found[module] = named
    assert {module: named for module, named in found.items() if module not in NAMING} == {}
    assert found.keys() == NAMING.keys()


def strings(path: Path) -> Iterator[str]:
    """The string constants of a module, the constant parts of f-strings too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
