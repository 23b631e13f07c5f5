"""A process of an editor that asks whether the clauses of a requirement can be violated: in `process.py`."""

from __future__ import annotations

import os
import re
from collections.abc import Container, Iterator
from itertools import chain, count
from typing import Any

from btq_lang.exploration.clauses import clause_answers
from btq_lang.exploration.missions import ExploredMission, NotExplored
from btq_lang.exploration.report import Explored, as_text, in_words
from btq_lang.exploration.search import SearchBudget
from btq_lang.projects.files import Files
from btq_lang.scenarios.explored import drawn, scenario_file, witnessed
from btq_lang.workspace.loader import shown


def explore_requirement(requirement: str, missions: list[str], texts: dict[str, str]) -> Iterator[dict[str, Any]]:
    """Whether the clauses of a requirement can be violated in missions, as plain data.

    Args:
        missions: their paths.
        texts: of open files, by path.

    Returns:
        Of each mission its `path`, the `clauses`, each with its `text`, the `answer`, the number of `states` and a
        `message`, the runs as `text`, and the `scenarios` that say what happens in them: the `path` of a file that does
        not exist and its `text`; None without any; and the `problem` if it cannot be explored, else an empty text.
    """
    files = Files()
    files.overlay = texts
    for path in missions:
        workspace = next(group.workspace for group in files.groups([path], with_xml=True)[0] if path in group.given)
        try:
            mission = ExploredMission(workspace, path)
            clauses = tuple(clause_answers(mission, SearchBudget(), requirement))
        except NotExplored as problem:
            yield _as_problem(path, str(problem))
            continue
        except RecursionError:
            yield _as_problem(path, "its tree is nested too deeply")
            continue
        stem = os.path.join(os.path.dirname(path), re.sub(r"\W+", "_", requirement))
        yield _as_data(Explored(mission, (), clauses, None), _new_path(f"{stem}_violated", texts))


def _as_data(explored: Explored, target: str) -> dict[str, Any]:
    scenarios = [scenario for _, scenario in witnessed(explored, target) if scenario is not None]
    text = as_text([explored]) + "".join(f"{line}\n" for line in drawn(scenarios))
    return {
        "path": explored.mission.path,
        "clauses": [
            {
                "text": clause.text,
                "answer": clause.answer.word,
                "states": clause.answer.states,
                "message": in_words(clause),
            }
            for clause in explored.clauses
        ],
        "text": text,
        "scenarios": {"path": target, "text": scenario_file(explored, target, scenarios)} if scenarios else None,
        "problem": "",
    }


def _as_problem(path: str, problem: str) -> dict[str, Any]:
    return {"path": path, "clauses": [], "text": "", "scenarios": None, "problem": f"{shown(path)}: {problem}"}


def _new_path(stem: str, texts: Container[str]) -> str:
    """The path of a file that neither exists nor is open."""
    paths = (f"{stem}{number}.btq" for number in chain(("",), count(2)))
    return next(path for path in paths if path not in texts and not os.path.exists(path))
