"""`btq explore`: what can happen in a mission when its leaves do anything."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.commands.explored_scenarios import RUN_SUFFIXES, drawn_runs, write_runs
from btq_lang.commands.output import form_of, write_output
from btq_lang.exploration import FORMATS
from btq_lang.exploration.answers import Answer, answered
from btq_lang.exploration.clauses import clause_answers, unasked_clauses
from btq_lang.exploration.missions import ExploredMission, NotExplored, explorable
from btq_lang.exploration.questions import NoQuestion, Question, parse_question
from btq_lang.exploration.report import AskedQuestion, Explored, as_json, as_text
from btq_lang.exploration.search import SearchBudget
from btq_lang.exploration.surveys import Survey, surveyed
from btq_lang.exploration.watching import Unasked
from btq_lang.projects.files import Files, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.util.record import Record
from btq_lang.workspace.loader import shown


class ExploreOptions(Record):
    """The options of `btq explore`.

    Attributes:
        can, never: questions.
        tree: the tree that the program creates; None: the main tree.
        states: how many states are searched for each question.
        seconds: how much processor time, likewise; None: any.
        strict: what was not found in a search that was cut off may happen.
        show: draw the runs; a page always does.
        format: of FORMATS; None: as the output's name ends.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    can: Sequence[str]
    never: Sequence[str]
    tree: str | None
    states: int
    seconds: float | None
    strict: bool
    show: bool
    format: str | None
    output: str | None


def run(options: ExploreOptions, messages: CommandOutput) -> int:
    """Answer the questions for each mission, or the standard ones."""
    refuse(usage_problem(options.paths))
    form = form_of(options.format, options.output, FORMATS)
    if options.show and form == "json":
        raise Refused("--show draws runs as text, and --format json has none")
    questions = [(_question(text), is_wanted) for is_wanted, text in _texts(options)]
    groups, problems = Files().groups(options.paths, options.stdin_filename, with_xml=True)
    messages.problems(problems)
    refuse(no_mission_below(options.paths, groups))
    if problems:
        return 2
    budget = SearchBudget(options.states, options.seconds)
    code = 0
    explored: list[Explored] = []
    unasked: list[tuple[Question, str, str]] = []
    for group in groups:
        paths = group.given if options.tree else tuple(explorable(group.workspace, group.given))
        for path in paths:
            try:
                mission = ExploredMission(group.workspace, path, options.tree or "")
                asked = [*_asked(mission, questions, budget, unasked)]
                clauses = tuple(clause_answers(mission, budget)) if not questions else ()
                survey = surveyed(mission, budget) if not questions else None
            except (NotExplored, RecursionError) as problem:
                reason = "its tree is nested too deeply" if isinstance(problem, RecursionError) else problem
                messages.remark(f"btq explore: {shown(path)}: {reason}")
                code = 2
                continue
            codes = [_code_of(each.answer, each.is_wanted, options.strict) for each in asked]
            codes += [_code_of(clause.answer, False, options.strict) for clause in clauses]
            code = max(code, _survey_code(survey, options.strict), *codes)
            if asked or not questions:
                clauses_left_out = unasked_clauses(mission) if not questions else ()
                explored.append(Explored(mission, tuple(asked), clauses, survey, clauses_left_out))
    answered_somewhere = [each.question for one in explored for each in one.asked]
    for question, path, reason in unasked:
        if question not in answered_somewhere:
            messages.remark(f"btq explore: {shown(path)}: {reason}")
            code = 2
    if not explored and not code:
        raise Refused("no mission has a main tree; choose one with --tree")
    if explored:
        text = _written(explored, form)
        text += drawn_runs(explored, messages) if options.show and form == "text" else ""
        if options.output is not None and options.output.endswith(RUN_SUFFIXES):
            write_output(messages, None, text)
            write_runs(explored, options.output, messages)
        else:
            write_output(messages, options.output, text)
    return code


def _written(explored: Sequence[Explored], form: str) -> str:
    if form == "html":
        from btq_lang.scenarios.explored_page import render

        return render(explored)
    return as_json(explored) if form == "json" else as_text(explored)


def _texts(options: ExploreOptions) -> Sequence[tuple[bool, str]]:
    return [*[(True, text) for text in options.can], *[(False, text) for text in options.never]]


def _question(text: str) -> Question:
    try:
        return parse_question(text)
    except NoQuestion as problem:
        raise Refused(f"`{text}`: {problem}") from None


def _asked(
    mission: ExploredMission,
    questions: Sequence[tuple[Question, bool]],
    budget: SearchBudget,
    unasked: list[tuple[Question, str, str]],
) -> Iterator[AskedQuestion]:
    """The questions with their answers; `unasked`: gets those that cannot be asked of the mission, and why."""
    for question, is_wanted in questions:
        try:
            yield AskedQuestion(question, is_wanted, answered(mission, question, budget))
        except Unasked as problem:
            unasked.append((question, mission.path, str(problem)))


def _survey_code(survey: Survey | None, strict: bool) -> int:
    """Whether something was found, or not all was seen."""
    return int(survey is not None and (bool(survey.findings) or (strict and not survey.is_closed)))


def _code_of(answer: Answer, is_wanted: bool, strict: bool) -> int:
    """Whether an answer is not the wanted one."""
    if answer.word == "not found":
        return int(is_wanted or strict)
    return int((answer.word == "yes") != is_wanted)
