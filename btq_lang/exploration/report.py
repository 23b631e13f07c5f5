"""Answers as text for people, and as JSON whose form `explore.schema.json` has."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Sequence
from typing import Final

from btq_lang.exploration.answers import Answer
from btq_lang.exploration.clauses import ClauseAnswer, UnaskedClause
from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.questions import Question
from btq_lang.exploration.surveys import Survey
from btq_lang.exploration.witness import Tick
from btq_lang.requirements.fingerprint import Json
from btq_lang.util.record import Record, as_dict
from btq_lang.util.text import counted
from btq_lang.workspace.loader import shown


class AskedQuestion(Record):
    """A question and its answer; `is_wanted`: it is to be possible, rather than impossible."""

    question: Question
    is_wanted: bool
    answer: Answer


class Explored(Record):
    """What was asked of a mission."""

    mission: ExploredMission
    asked: tuple[AskedQuestion, ...]
    clauses: tuple[ClauseAnswer, ...]
    survey: Survey | None
    unasked: tuple[UnaskedClause, ...] = ()


class ReportedAnswer(Record):
    """An answer in words, with its run.

    Attributes:
        title: what was asked, or the name of what was found without a question.
        text: the answer.
        is_wanted: whether the answer is the wanted one; None: that is open.
        notes: what it assumes, and what is not known.
        witness, circle: the run, and the ticks that it can repeat without an end.
        hidden: the entries of the run that have no part in it.
    """

    title: str
    text: str
    is_wanted: bool | None
    notes: tuple[str, ...] = ()
    witness: tuple[Tick, ...] = ()
    circle: tuple[Tick, ...] = ()
    hidden: Collection[str] = ()


def as_text(explored: Sequence[Explored]) -> str:
    """For people: an answer a paragraph, its witness below it, tick by tick."""
    return "".join(f"{line}\n" for each in explored for line in _lines(each))


def _lines(explored: Explored) -> Iterator[str]:
    yield heading(explored.mission)
    for answer in reported_answers(explored):
        yield from _paragraph(explored.mission, answer)
    yield from (f"  not asked: {each.requirement} `{each.text}`: {each.why}" for each in explored.unasked)
    if explored.survey is not None:
        first, *unknown = survey_summary(explored.survey)
        yield f"  {first}"
        yield from (f"    {line}" for line in unknown)
    for finding in reported_findings(explored):
        yield from _paragraph(explored.mission, finding)


def _paragraph(mission: ExploredMission, answer: ReportedAnswer) -> Iterator[str]:
    yield f"  {answer.title}: {answer.text}"
    yield from (f"    {note}" for note in answer.notes)
    yield from _run(mission, answer.witness, answer.hidden)
    if answer.circle:
        yield f"    {AGAIN}:"
        yield from _run(mission, answer.circle, answer.hidden, len(answer.witness) + 1)


def heading(mission: ExploredMission) -> str:
    """The mission, and what it is explored on."""
    engine = f"BehaviorTree.CPP {mission.dialect.version}"
    nav2 = f", Nav2 {mission.dialect.nav2.title()}" if mission.dialect.nav2 else ""
    nav2 += f' (assumed; name it: nodes = ["nav2-{mission.dialect.nav2}"])' if mission.program.is_nav2_assumed else ""
    return f"{shown(mission.path)}: tree {mission.tree}, {engine}{nav2}"


def reported_answers(explored: Explored) -> Iterator[ReportedAnswer]:
    """Those to questions, then those about clauses."""
    for asked in explored.asked:
        title = f"{'can' if asked.is_wanted else 'never'} {asked.question.text}"
        yield _reported(explored.mission, title, asked.answer, asked.is_wanted, asked.question.keys)
    for clause in explored.clauses:
        yield _reported(explored.mission, _clause_question(clause), clause.answer, False)


def _reported(
    mission: ExploredMission, title: str, answer: Answer, is_wanted: bool, keys: Collection[str] = ()
) -> ReportedAnswer:
    assumed = ("if what is calculated from entries can have such values",) if answer.is_assumed else ()
    notes = (*assumed, *_not_known(answer.unknown))
    hidden = mission.without_part([*answer.witness, *answer.circle]).difference(keys)
    is_as_wanted = None if answer.word == "not found" else (answer.word == "yes") == is_wanted
    return ReportedAnswer(title, _word(answer), is_as_wanted, notes, answer.witness, answer.circle, hidden)


def reported_findings(explored: Explored) -> Iterator[ReportedAnswer]:
    """What was found without a question."""
    mission = explored.mission
    for finding in explored.survey.findings if explored.survey is not None else ():
        rule = f"; btq check: {finding.rule}" if finding.rule else ""
        text = f"{finding.text}{_at(mission, finding.uid)}{rule}"
        hidden = mission.without_part(finding.witness)
        yield ReportedAnswer(finding.kind, text, False, witness=finding.witness, hidden=hidden)


def survey_summary(survey: Survey) -> Iterator[str]:
    """How many states were seen, then what is not known, a line each."""
    seen = "all" if survey.is_closed else "not all: the first"
    yield f"{seen} {counted(survey.states, 'state')} seen{'' if survey.is_counted else _UNCOUNTED}"
    yield from _not_known(survey.unknown)


def _not_known(reasons: Sequence[str]) -> Iterator[str]:
    return (f"not known: {reason}" for reason in reasons)


def in_words(clause: ClauseAnswer) -> str:
    """Whether a clause can be violated."""
    return f"{_clause_question(clause)}: {_word(clause.answer)}"


def _clause_question(clause: ClauseAnswer) -> str:
    return f"{clause.requirement} `{clause.text}` can be violated"


def _word(answer: Answer) -> str:
    if answer.word == "yes":
        return f"yes, in {counted(len(answer.witness) + len(answer.circle), 'tick')}"
    if answer.word == "no":
        return f"no, in all {counted(answer.states, 'state')}{'' if answer.is_counted else _UNCOUNTED}"
    return f"not found in {counted(answer.states, 'state')}"


def _run(mission: ExploredMission, ticks: Sequence[Tick], hidden: Collection[str], first: int = 1) -> Iterator[str]:
    """A run, tick by tick, without some entries; `first`: the number of its first tick."""
    for number, tick in enumerate(ticks, start=first):
        yield f"    tick {number}"
        for deed in tick.deeds:
            yield f"      {deed.path} {deed.what}{_at(mission, deed.uid)}"
        yield from (f"      {{{key}}} {text}" for key, text in tick.entries if key not in hidden)
        if end := end_of(tick):
            yield f"      the mission {end}"


def end_of(tick: Tick) -> str:
    """What the mission does in its last tick; empty: it runs on, or the tick is not finished."""
    if tick.result in ("runs", ""):
        return ""
    return f"{tick.result}{f': {tick.message}' if tick.message else ''}"


def _at(mission: ExploredMission, uid: int) -> str:
    place = place_of(mission, uid)
    return f"  ({place})" if place else ""


def place_of(mission: ExploredMission, uid: int) -> str:
    """The file and line of a node; empty: it has none."""
    place = mission.place(uid)
    return f"{shown(place[0])}:{place[1]}" if place is not None else ""


def as_json(explored: Sequence[Explored]) -> str:
    """For programs."""
    missions: list[Json] = [_mission(each) for each in explored]
    return (
        json.dumps({"format": "btq-explore", "version": _VERSION, "missions": missions}, indent=2, ensure_ascii=False)
        + "\n"
    )


def _mission(explored: Explored) -> Json:
    mission = explored.mission
    record: dict[str, Json] = {
        "file": shown(mission.path),
        "tree": mission.tree,
        "engine": mission.dialect.version,
        "questions": [
            {
                "text": asked.question.text,
                "asked": "can" if asked.is_wanted else "never",
                **_answer(mission, asked.answer),
            }
            for asked in explored.asked
        ],
        "clauses": [
            {"requirement": clause.requirement, "text": clause.text, **_answer(mission, clause.answer)}
            for clause in explored.clauses
        ],
    }
    record["not_asked"] = [as_dict(clause) for clause in explored.unasked]
    if mission.dialect.nav2:
        record["nav2"] = mission.dialect.nav2
    if (survey := explored.survey) is not None:
        record["survey"] = {
            "states": survey.states,
            "closed": survey.is_closed,
            "unknown": list(survey.unknown),
            "counted": survey.is_counted,
            "findings": [
                {
                    "kind": finding.kind,
                    "text": finding.text,
                    **_node(mission, finding.uid),
                    **({"rule": finding.rule} if finding.rule else {}),
                    "witness": _ticks(mission, finding.witness),
                }
                for finding in survey.findings
            ],
        }
    return record


def _answer(mission: ExploredMission, answer: Answer) -> dict[str, Json]:
    return {
        "answer": answer.word,
        "states": answer.states,
        "assumed": answer.is_assumed,
        "unknown": list(answer.unknown),
        "counted": answer.is_counted,
        "witness": _ticks(mission, answer.witness),
        "circle": _ticks(mission, answer.circle),
    }


def _ticks(mission: ExploredMission, ticks: Sequence[Tick]) -> Json:
    return [
        {
            "deeds": [{"path": deed.path, "what": deed.what, **_node(mission, deed.uid)} for deed in tick.deeds],
            "entries": dict(tick.entries),
            "result": tick.result,
            "message": tick.message,
        }
        for tick in ticks
    ]


def _node(mission: ExploredMission, uid: int) -> dict[str, Json]:
    """The number of a node and its place."""
    if uid == 0:
        return {}
    place = mission.place(uid)
    return {"uid": uid} if place is None else {"uid": uid, "file": shown(place[0]), "line": place[1]}


AGAIN: Final = "and from here again and again"
_UNCOUNTED: Final = ", with any number of attempts"
_VERSION: Final = 1
