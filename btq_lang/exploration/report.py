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


def as_text(explored: Sequence[Explored]) -> str:
    """For people: an answer a paragraph, its witness below it, tick by tick."""
    return "".join(f"{line}\n" for each in explored for line in _lines(each))


def _lines(explored: Explored) -> Iterator[str]:
    mission = explored.mission
    engine = f"BehaviorTree.CPP {mission.dialect.version}"
    nav2 = f", Nav2 {mission.dialect.nav2.title()}" if mission.dialect.nav2 else ""
    nav2 += f' (assumed; name it: nodes = ["nav2-{mission.dialect.nav2}"])' if mission.program.is_nav2_assumed else ""
    yield f"{shown(mission.path)}: tree {mission.tree}, {engine}{nav2}"
    for asked in explored.asked:
        answer = asked.answer
        yield f"  {'can' if asked.is_wanted else 'never'} {asked.question.text}: {_word(answer)}"
        if answer.is_assumed:
            yield "    if what is calculated from entries can have such values"
        yield from (f"    not known: {reason}" for reason in answer.unknown)
        hidden = mission.without_part([*answer.witness, *answer.circle]).difference(asked.question.keys)
        yield from _run(mission, answer.witness, hidden)
        if answer.circle:
            yield "    and from here again and again:"
            yield from _run(mission, answer.circle, hidden, len(answer.witness) + 1)
    for clause in explored.clauses:
        yield f"  {in_words(clause)}"
        if clause.answer.is_assumed:
            yield "    if what is calculated from entries can have such values"
        yield from (f"    not known: {reason}" for reason in clause.answer.unknown)
        yield from _run(mission, clause.answer.witness, mission.without_part(clause.answer.witness))
    yield from (f"  not asked: {each.requirement} `{each.text}`: {each.why}" for each in explored.unasked)
    if explored.survey is not None:
        survey = explored.survey
        seen = "all" if survey.is_closed else "not all: the first"
        yield f"  {seen} {counted(survey.states, 'state')} seen{'' if survey.is_counted else _UNCOUNTED}"
        yield from (f"    not known: {reason}" for reason in survey.unknown)
        for finding in survey.findings:
            rule = f"; btq check: {finding.rule}" if finding.rule else ""
            yield f"  {finding.kind}: {finding.text}{_at(mission, finding.uid)}{rule}"
            yield from _run(mission, finding.witness, mission.without_part(finding.witness))


def in_words(clause: ClauseAnswer) -> str:
    """Whether a clause can be violated."""
    return f"{clause.requirement} `{clause.text}` can be violated: {_word(clause.answer)}"


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
        if tick.result not in ("runs", ""):
            yield f"      the mission {tick.result}{f': {tick.message}' if tick.message else ''}"


def _at(mission: ExploredMission, uid: int) -> str:
    place = mission.place(uid)
    return f"  ({shown(place[0])}:{place[1]})" if place is not None else ""


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


_UNCOUNTED: Final = ", with any number of attempts"
_VERSION: Final = 1
