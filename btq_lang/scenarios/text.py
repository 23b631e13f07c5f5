"""Results for people: a line a scenario, and of those that are not as expected the first step that differs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.evidence.wording import duration
from btq_lang.render.cells import printable
from btq_lang.render.colour import Paint, painter
from btq_lang.scenarios.results import ExpectationResult, Outcome, ScenarioReport, ScenarioResult, Step
from btq_lang.scenarios.thoroughness_text import coverage_lines, mutant_lines
from btq_lang.util.text import counted


def render(report: ScenarioReport, colour: bool = False) -> str:
    """The results of all scenarios, and how many there are of each."""
    paint = painter(colour)
    lines = [line for scenario in report.scenarios for line in scenario_lines(scenario, paint)]
    lines.append(counts(report))
    lines += coverage_lines(report.coverage) if report.coverage is not None else ()
    lines += mutant_lines(report.mutants) if report.mutants is not None else ()
    return "\n".join(lines) + "\n"


def counts(report: ScenarioReport) -> str:
    """How many scenarios there are, and of each outcome."""
    numbers = [f"{number} {word}" for outcome, word in _COUNTED.items() if (number := report.count(outcome))]
    where = f" in BehaviorTree.CPP {report.engine}" if report.engine else ""
    return f"{counted(len(report.scenarios), 'scenario')}{where}: {', '.join(numbers)}"


def scenario_lines(scenario: ScenarioResult, paint: Paint) -> Iterator[str]:
    """The result of a scenario: a line, and more if it is not as expected or drawn."""
    mark = paint(_STYLES[scenario.outcome], scenario.outcome.ljust(_WIDTH))
    ended = f": {scenario.ended} after {duration(scenario.seconds)}" if scenario.expectations else ""
    yield f"{mark} {printable(f'{scenario.title} ({scenario.file}:{scenario.line}){ended}')}"
    blank = " " * (_WIDTH + 1)
    yield from (printable(f"{blank}{line}") for line in scenario.why.splitlines())
    for expectation in scenario.expectations:
        if expectation.outcome != "passed":
            yield from (printable(f"{blank}{line}") for line in _expectation(expectation))
        if expectation.note:
            yield printable(f"{blank}line {expectation.line} expects {expectation.text}; {expectation.note}")
    yield from (printable(f"{blank}{note}") for note in scenario.notes)
    yield from (printable(f"{blank}  {line}") for line in scenario.drawing)
    if scenario.assumed and (scenario.drawing or scenario.outcome != "passed"):
        yield printable(f"{blank}ASSUMED to succeed at once: {', '.join(scenario.assumed)}")


def _expectation(expectation: ExpectationResult) -> Iterator[str]:
    line = f"line {expectation.line}: " if expectation.line else ""
    yield f"{line}expect {expectation.text}"
    yield f"  {step_in_words(expectation.step)}" if expectation.step is not None else f"  unknown: {expectation.why}"


def step_in_words(step: Step) -> str:
    """The first step that differs."""
    place = f" ({step.file}:{step.line})" if step.file else ""
    return f"after {duration(step.at)} {step.node}{place}: {step.happened}; expected {step.expected}"


_WIDTH: Final = 7
_COUNTED: Final[dict[Outcome, str]] = {
    "passed": "passed",
    "failed": "failed",
    "unknown": "unknown",
    "error": "with an error",
}
_STYLES: Final[dict[Outcome, str]] = {"passed": "hint", "failed": "error", "unknown": "warning", "error": "error"}
