"""The hubs of the query store: none depends on another through a query that is none (see `hub` in
workspace/queries.py)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from btq_lang import checks, open_workspace
from btq_lang.checks import calls, enforcement, placeholders, requirements, view
from btq_lang.requirements import nodes
from btq_lang.workspace import queries

EXAMPLES = Path(__file__).parents[2] / "examples"
HUBS = {
    calls._callers,
    calls._circles,
    calls._missed,
    calls.callers,
    calls.is_main,
    requirements.is_measured,
    nodes.has_nodes,
    placeholders._first_names,
    enforcement._callers,
    view._is_main_tree,
}


def reached(answer: Any) -> Iterator[Any]:
    """All queries on which one depends through queries that are no hubs, and whether it depends on them directly."""
    waiting, seen = list(answer.dependencies), set()
    while waiting:
        each = waiting.pop()
        if each not in seen:
            seen.add(each)
            yield each.key[0], each in answer.dependencies
            waiting += each.dependencies if each.key[0] not in queries._HUBS else ()


def test_no_hub_depends_on_another_through_other_queries() -> None:
    met = set()
    for example in EXAMPLES.iterdir():
        workspace = open_workspace(str(example))
        for path in workspace.files:
            checks.findings(workspace.store, path)
        for answer in workspace.store._answers.values():
            if answer.key[0] in queries._HUBS:
                met.add(answer.key[0])
                assert [of for of, is_direct in reached(answer) if of in queries._HUBS and not is_direct] == []
    assert met == HUBS
