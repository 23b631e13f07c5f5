"""Scenarios: which there are, and what comes of running them, in a process of its own for each request.

One invariant: what runs are the texts as the editor has them when it asks; an edit meanwhile waits for nothing, and
what a run has shown of an earlier text is in its answer, but in no diagnostic.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import aclosing
from typing import TYPE_CHECKING, Any, Final

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.commands import mission_at
from btq_lang.lsp.editor import Handlers, RequestRefused, Server
from btq_lang.lsp.processes import answers_of
from btq_lang.lsp.progress import progress
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace

LIST = "btq.server.scenarios"
RUN = "btq.server.runScenarios"
COVER = "btq.server.coverScenarios"
SHOW = "btq.server.showScenarios"


handlers = Handlers()


@handlers.command(LIST)
async def listed(server: Server, document: types.TextDocumentIdentifier | None) -> list[dict[str, object]]:
    """The scenarios of a document, or of all files of the open folders; files without any are left out."""
    await server.scanned.wait()
    paths = server.session.paths() if document is None else [server.convert.path(document.uri)]
    places = [(workspace, path) for path in paths if (workspace := server.session.workspace_of(path)) is not None]
    of_files = [(workspace, path, features.scenarios.listed(workspace, path)) for workspace, path in places]
    return [
        {
            "uri": server.convert.uri(path),
            "scenarios": [
                {"title": each.title, "range": server.convert.range(workspace, path, each.span)} for each in scenarios
            ],
        }
        for workspace, path, scenarios in of_files
        if scenarios
    ]


@handlers.command(RUN)
async def run(server: Server, document: types.TextDocumentIdentifier, *titles: str) -> list[dict[str, Any]]:
    """Run the scenarios of a document that have one of these titles, or all; what a run shows becomes diagnostics."""
    return (await _ran(server, document, titles, is_covered=False))[0]


@handlers.command(COVER)
async def cover(server: Server, document: types.TextDocumentIdentifier, *titles: str) -> dict[str, object]:
    """Run scenarios, and tell what they have met of all that can happen to nodes."""
    results, coverage = await _ran(server, document, titles, is_covered=True)
    return {"results": results, "coverage": coverage}


@handlers.command(SHOW)
async def show(server: Server, document: types.TextDocumentIdentifier, *titles: str) -> None:
    """Run scenarios for an editor without a list of their results: a message has them."""
    results = await run(server, document, *titles)
    words = [f"{each['outcome']}: {each['title']}\n{each['message']}".strip() for each in results]
    kind = types.MessageType.Info
    if any(each["outcome"] != "passed" for each in results):
        kind = types.MessageType.Warning
    server.window_show_message(types.ShowMessageParams(kind, "\n".join(words)))


async def _ran(
    server: Server, document: types.TextDocumentIdentifier, titles: Sequence[str], *, is_covered: bool
) -> tuple[list[dict[str, Any]], list[dict[str, object]]]:
    """What comes of scenarios, and the coverage by file if it is wanted."""
    workspace, path = mission_at(server, document)
    scenarios = features.scenarios.listed(workspace, path)
    number = sum(not titles or each.title in titles for each in scenarios)
    if not number:
        raise RequestRefused("this document has no such scenario" if titles else "this document has no scenario")
    folder = server.session.folders[0] if server.session.folders else os.path.dirname(path)
    texts = {**server.session.open, path: workspace.files[path].source}  # as they are now
    asked: dict[str, object] = {"path": path, "texts": texts, "titles": titles, "is_covered": is_covered}
    results: list[dict[str, Any]] = []
    coverage: list[dict[str, object]] = []
    async with (
        progress(server, "running scenarios") as report,
        aclosing(answers_of(folder, _PROGRAM, asked)) as running,
    ):
        async for ran in running:
            if "coverage" in ran:
                coverage = _coverage(server, workspace, folder, ran["coverage"])
                continue
            scenario = scenarios[ran["number"]]
            failures = features.scenarios.failures(scenario, folder, ran)
            written = [server.convert.failure(workspace, path, each) for each in failures]
            server.tested.add(workspace, path, ran["number"], written)
            results.append(
                {
                    "title": scenario.title,
                    "range": server.convert.range(workspace, path, scenario.head),
                    "outcome": ran["outcome"],
                    "message": "\n".join(each.message for each in failures),
                    "failures": [
                        {"range": server.convert.range(workspace, path, each.span), "message": each.message}
                        for each in failures
                    ],
                    "text": "\n".join(ran["lines"]),
                }
            )
            report(100 * len(results) // number, f"{len(results)} of {counted(number, 'scenario')}")
    server.schedule.check_soon((path,))
    return results, coverage


def _coverage(
    server: Server, workspace: Workspace, folder: str, coverage: dict[str, list[dict[str, Any]]]
) -> list[dict[str, object]]:
    """What scenarios have met, by file, with positions in the editor."""
    from btq_lang.workspace.loader import absolute  # it imports workspaces, which are not needed to start

    by_file: dict[str, dict[str, list[dict[str, Any]]]] = {}
    for kind, places in coverage.items():
        for place in places:
            path = absolute(os.path.join(folder, place.pop("file")))
            position = server.convert.position(workspace, path, place.pop("line") - 1, place.pop("column") - 1)
            by_file.setdefault(path, {"nodes": [], "unused": []})[kind].append({"position": position, **place})
    return [{"uri": server.convert.uri(path), **places} for path, places in by_file.items()]


_PROGRAM: Final = "from btq_lang.scenarios.process import print_answers, run_titles; print_answers(run_titles)"
