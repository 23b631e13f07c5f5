"""JUnit XML: a suite for each mission, a case for each requirement.

One invariant: the names of a case's properties are unique.  `verifies` is the requirement's ID, which
sphinx-test-reports turns into links (`tr_property_link_types`) and StrictDoc into a field of its test results; both
read one property with several IDs, separated by commas, as `refines` and `mitigates` are.  StrictDoc refuses a repeated
name, and `<error>`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.evidence.sentences import explained, headline, result
from btq_lang.evidence.verdicts import (
    NEVER,
    SATISFIED,
    VIOLATED,
    ClauseVerdict,
    MissionVerdicts,
    RequirementVerdict,
    VerdictReport,
)
from btq_lang.evidence.wording import timestamp
from btq_lang.render.junit import escaped


def render(report: VerdictReport) -> str:
    """The document: a violated requirement is a failure, one neither violated nor satisfied is skipped."""
    return "".join(f"{line}\n" for line in _lines(report))


def _lines(report: VerdictReport) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    every = [requirement for mission in report.missions for requirement in mission.requirements]
    yield f'<testsuites name="btq verify" {_numbers(every)}>'
    for mission in report.missions:
        begin = next((source.begin for source in mission.sources if source.begin is not None), 0)
        name = escaped(mission.name)
        start = timestamp(begin).partition(".")[0]
        yield f'  <testsuite name="{name}" {_numbers(mission.requirements)} time="0" timestamp="{start}">'
        for requirement in mission.requirements:
            yield from _case(requirement, mission)
        yield "  </testsuite>"
    yield "</testsuites>"


def _numbers(requirements: Sequence[RequirementVerdict]) -> str:
    verdicts = [requirement.verdict for requirement in requirements]
    failures = verdicts.count(VIOLATED)
    skipped = len(verdicts) - failures - verdicts.count(SATISFIED)
    return f'tests="{len(verdicts)}" failures="{failures}" errors="0" skipped="{skipped}"'


def _case(requirement: RequirementVerdict, mission: MissionVerdicts) -> Iterator[str]:
    yield f'    <testcase classname="{escaped(mission.name)}" name="{escaped(requirement.id)}" time="0">'
    links = requirement.links
    properties = {
        "verifies": requirement.id,
        "refines": ",".join(links.refines),
        "mitigates": ",".join(links.mitigates),
        "verified_by": ",".join(links.verified_by),
        "source": "; ".join(links.sources),
        "priority": links.priority,
        "suspect": "true" if requirement.is_suspect else "",
    }
    listed = (f'<property name="{name}" value="{escaped(value)}"/>' for name, value in properties.items() if value)
    yield f"      <properties>{''.join(listed)}</properties>"
    worst = next(clause for clause in requirement.clauses if clause.verdict == requirement.verdict)
    if requirement.verdict == VIOLATED:
        yield f'      <failure type="violated" message="{escaped(headline(worst, mission.medians))}">'
        lines = [line for clause in requirement.clauses for line in _details(clause, mission)]
        yield "\n".join(map(escaped, lines)) + "</failure>"
    elif requirement.verdict != SATISFIED:
        message = escaped(f"{requirement.verdict}: {result(worst)}")
        yield f'      <skipped type="{requirement.verdict}" message="{message}"/>'
    else:
        lines = [f"{clause.text}{_at(clause)}: {result(clause)}" for clause in requirement.clauses]
        yield f"      <system-out>{escaped('; '.join(lines))}</system-out>"
    yield "    </testcase>"


def _at(clause: ClauseVerdict) -> str:
    """The node of a clause at which nothing was exercised, though the requirement is satisfied."""
    return f" at {clause.path}, {NEVER}" if clause.verdict == NEVER and clause.path else ""


def _details(clause: ClauseVerdict, mission: MissionVerdicts) -> Iterator[str]:
    yield f"{clause.text} at {clause.path}: {clause.verdict}, {result(clause)}"
    if clause.verdict == VIOLATED:
        yield from (f"  {explained(clause, violation, mission.medians)}" for violation in clause.violations[:_SHOWN])


_SHOWN = 10  # violations of a clause
