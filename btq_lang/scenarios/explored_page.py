"""What can happen in missions as a page: each answer, and its run, tick by tick and as a drawing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.report import (
    AGAIN,
    Explored,
    ReportedAnswer,
    end_of,
    heading,
    place_of,
    reported_answers,
    reported_findings,
    survey_summary,
)
from btq_lang.exploration.witness import Tick
from btq_lang.render.pages import page
from btq_lang.scenarios.explored import witnessed

if TYPE_CHECKING:
    from btq_lang.render.pages import PageData


def render(explored: Sequence[Explored]) -> str:
    """The page."""
    missions = [_mission(each) for each in explored]
    return page("scenarios/explored_page.html.j2", title="What can happen", missions=missions)


def _mission(explored: Explored) -> PageData:
    scenarios = (scenario for _, scenario in witnessed(explored, f"{explored.mission.path}.runs.btq"))
    answers: list[PageData] = []
    for answer in (*reported_answers(explored), *reported_findings(explored)):
        scenario = next(scenarios) if answer.witness or answer.circle else None
        answers.append(
            {
                "title": answer.title,
                "text": answer.text,
                "style": _STYLES[answer.is_wanted],
                "notes": answer.notes,
                "runs": [*_runs(explored.mission, answer)],
                "drawing": "\n".join(scenario.drawing) if scenario is not None else "",
            }
        )
    return {
        "heading": heading(explored.mission),
        "summary": [*survey_summary(explored.survey)] if explored.survey is not None else [],
        "answers": answers,
        "unasked": explored.unasked,
    }


def _runs(mission: ExploredMission, answer: ReportedAnswer) -> Iterator[tuple[str, list[PageData]]]:
    """The ticks of a run, then those of its circle, each with a caption."""
    for caption, ticks, first in (
        ("Tick by tick", answer.witness, 1),
        (AGAIN, answer.circle, len(answer.witness) + 1),
    ):
        if ticks:
            yield caption, [_tick(mission, answer, tick, number) for number, tick in enumerate(ticks, start=first)]


def _tick(mission: ExploredMission, answer: ReportedAnswer, tick: Tick, number: int) -> PageData:
    rows = [(deed.path, deed.what, place_of(mission, deed.uid)) for deed in tick.deeds]
    if end := end_of(tick):
        rows.append(("the mission", end, ""))
    entries = [f"{{{key}}} {text}" for key, text in tick.entries if key not in answer.hidden]
    return {"number": number, "rows": rows or [("", "", "")], "entries": entries}


_STYLES: Final = {True: "satisfied", False: "violated", None: "unknown"}
