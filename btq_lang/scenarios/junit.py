"""JUnit XML: a suite for each file, a case for each scenario.

One invariant: the names of a case's properties are unique; `verifies` has the IDs of requirements, as in `btq verify`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.render.junit import escaped
from btq_lang.scenarios.results import ScenarioReport, ScenarioResult
from btq_lang.scenarios.text import step_in_words
from btq_lang.util.grouping import grouped


def render(report: ScenarioReport, colour: bool = False) -> str:
    """The document, which has no colours: an unknown scenario is skipped, one with an error has an `<error>`."""
    return "".join(f"{line}\n" for line in _lines(report))


def _lines(report: ScenarioReport) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield f'<testsuites name="btq test" {_numbers(report.scenarios)}>'
    for file, scenarios in grouped((scenario.file, scenario) for scenario in report.scenarios).items():
        yield f'  <testsuite name="{escaped(file)}" {_numbers(scenarios)} time="0">'
        for scenario in scenarios:
            yield from _case(scenario)
        yield "  </testsuite>"
    yield "</testsuites>"


def _numbers(scenarios: Sequence[ScenarioResult]) -> str:
    outcomes = [scenario.outcome for scenario in scenarios]
    failures, errors, skipped = (outcomes.count(outcome) for outcome in ("failed", "error", "unknown"))
    return f'tests="{len(outcomes)}" failures="{failures}" errors="{errors}" skipped="{skipped}"'


def _case(scenario: ScenarioResult) -> Iterator[str]:
    file, title = escaped(scenario.file), escaped(scenario.title)
    yield f'    <testcase classname="{file}" name="{title}" file="{file}" line="{scenario.line}" time="0">'
    if scenario.verifies:
        value = escaped(",".join(scenario.verifies))
        yield f'      <properties><property name="verifies" value="{value}"/></properties>'
    reasons = [
        f"expect {each.text}: {step_in_words(each.step) if each.step is not None else each.why}"
        for each in scenario.expectations
        if each.outcome != "passed"
    ]
    reasons = [scenario.why] if scenario.why else reasons
    if scenario.outcome in ("failed", "error"):
        tag = "failure" if scenario.outcome == "failed" else "error"
        yield f'      <{tag} type="{scenario.outcome}" message="{escaped(reasons[0])}">'
        yield "\n".join(map(escaped, (*reasons, *scenario.drawing))) + f"</{tag}>"
    elif scenario.outcome == "unknown":
        yield f'      <skipped type="unknown" message="{escaped(reasons[0])}"/>'
    yield "    </testcase>"
