"""Whether a requirement can be violated, asked of a process of its own until the next key.

One invariant: an answer is about the texts as the editor has them when it comes: an edit ends the search.
"""

from __future__ import annotations

import asyncio
import os
from contextlib import aclosing
from typing import Any, Final

from lsprotocol import types

from btq_lang import ide as features
from btq_lang.lsp.commands import mission_at
from btq_lang.lsp.editor import Handlers, RequestOutdated, RequestRefused, Server
from btq_lang.lsp.processes import answers_of
from btq_lang.lsp.progress import progress

EXPLORE = "btq.server.explore"
SHOW = "btq.server.showExplored"


handlers = Handlers()


@handlers.command(EXPLORE)
async def explore(server: Server, document: types.TextDocumentIdentifier, requirement: str) -> list[dict[str, Any]]:
    """Whether the clauses of a requirement that a document defines can be violated, for each of its missions."""
    asking = asyncio.ensure_future(_answers(server, document, requirement))
    server.explorations.add(asking)
    try:
        return await asking
    except asyncio.CancelledError:
        if asking in server.explorations:
            raise
        raise RequestOutdated(f"a text was edited: ask again whether `{requirement}` can be violated") from None
    finally:
        server.explorations.discard(asking)


@handlers.command(SHOW)
async def show(server: Server, document: types.TextDocumentIdentifier, requirement: str) -> None:
    """Explore for an editor that cannot open a run: a message has it."""
    answers = await explore(server, document, requirement)
    is_violated = any(clause["answer"] == "yes" for each in answers for clause in each["clauses"])
    kind = types.MessageType.Warning if is_violated else types.MessageType.Info
    message = "\n".join(each["text"] or each["problem"] for each in answers)
    server.window_show_message(types.ShowMessageParams(kind, message))


async def _answers(server: Server, document: types.TextDocumentIdentifier, requirement: str) -> list[dict[str, Any]]:
    await server.scanned.wait()  # before, the missions of a file are unknown
    workspace, path = mission_at(server, document)
    missions = features.violations.askable_missions(workspace, path, requirement)
    if not missions:
        raise RequestRefused(f"no mission demands by `{requirement}` what a run can violate without regard to time")
    folder = server.session.folders[0] if server.session.folders else os.path.dirname(path)
    texts = {**server.session.open, path: workspace.files[path].source}
    asked: dict[str, object] = {"requirement": requirement, "missions": missions, "texts": texts}
    answers: list[dict[str, Any]] = []
    async with (
        progress(server, f"exploring {requirement}") as report,
        aclosing(answers_of(folder, _PROGRAM, asked)) as coming,
    ):
        async for answer in coming:
            scenarios = answer["scenarios"]
            if scenarios is not None:
                scenarios["uri"] = server.convert.uri(scenarios.pop("path"))
            answers.append({"uri": server.convert.uri(answer.pop("path")), **answer})
            report(100 * len(answers) // len(missions), None)
    return answers


_PROGRAM: Final = """\
from btq_lang.scenarios.explore_process import explore_requirement
from btq_lang.scenarios.process import print_answers

print_answers(explore_requirement)
"""
