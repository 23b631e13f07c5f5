"""Sentences of an overview that several writers print."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.enforceability import WAYS_COUNTED
from btq_lang.evidence.meanings import SUSPECT
from btq_lang.trace.overview import (
    AppliedRequirement,
    ExternalRow,
    HazardRow,
    Overview,
    QualityRow,
    RequirementRow,
    VerificationRow,
)
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Verdict


def incomplete(overview: Overview) -> str:
    """What errors in the missions mean for the overview; empty without any."""
    what = "an error" if overview.errors == 1 else f"{overview.errors} errors"
    return f"the missions have {what}, so the overview may be incomplete; run btq check" if overview.errors else ""


def summary(overview: Overview) -> str:
    """All counts, in a sentence, and how many scenarios there are, in another."""
    rows = [row.scenarios for row in overview.requirements]
    of_all = (*rows, *(row.scenarios for row in overview.external))
    scenarios = {scenario.at: scenario for of_row in of_all for scenario in of_row}
    if not scenarios:
        return f"{_counts(overview)}."
    verify = f"{counted(len(scenarios), 'scenario')} {'verifies' if len(scenarios) == 1 else 'verify'}"
    outcomes = Counter(scenario.outcome for scenario in scenarios.values())
    came = ", ".join(f"{number} {outcome}" for outcome, number in sorted(outcomes.items()) if outcome)
    return f"{_counts(overview)}. {verify} {counted(len([*filter(None, rows)]), 'requirement')}; {came or NOT_RUN}."


def _counts(overview: Overview) -> str:
    of_rows = (use.clauses for row in overview.requirements for use in row.uses)
    clauses = [clause.way for clauses in of_rows for clause in clauses if clause.is_measurable]
    ways: dict[str, int] = {words: clauses.count(way) for way, words in WAYS_COUNTED.items()}
    ways["without a node"] = len(overview.loose)
    covered = ", ".join(f"{number} {way}" for way, number in ways.items() if number)
    sentence = f"{counted(len(overview.requirements), 'requirement')}"
    sentence += f" ({counted(sum(ways.values()), 'clause')}: {covered})" if covered else ""
    if hard := len(overview.unenforced):
        sentence += f", {hard} of them hard (on violation fail or halt) and not enforced everywhere"
    sentence += f", {counted(len(overview.qualities), 'quality', 'qualities')}"
    skills = overview.coverage()
    if not sum(skills.values()):
        return sentence
    whole = f"{sentence}; of {counted(sum(skills.values()), 'custom leaf node')}, {skills['own']}"
    whole += " carries" if skills["own"] == 1 else " carry"
    return (
        f"{whole} a quality or a requirement, {skills['above']} only through a node above, {skills['none']} not at all"
    )


def shown_quality(quality: QualityRow) -> str:
    """A quality's name, with the model's name if that differs."""
    id_ = quality.id
    return quality.name if id_ is None or id_.endswith(quality.name) else f"{quality.name} ({id_})"


def evidence_lines(requirement: RequirementRow) -> Iterator[tuple[Verdict, str]]:
    """What logs show of each clause: its verdict, and the counts, with its mission, text and node where several differ
    in them.
    """
    of_all = requirement.evidence
    for evidence in of_all:
        parts = [evidence.mission] if evidence.mission else []
        parts += [evidence.clause] if any(one.clause != evidence.clause for one in of_all) else []
        if any(
            (one.mission, one.clause) == (evidence.mission, evidence.clause) and one.path != evidence.path
            for one in of_all
        ):
            parts += [f"at {evidence.path}"] if evidence.path else []
        text = f"{' '.join(parts)}: {evidence.result}" if parts else evidence.result
        yield evidence.verdict, f"{text}; {SUSPECT}" if evidence.is_suspect else text


def remarks(requirement: RequirementRow, use: AppliedRequirement) -> Iterator[str]:
    """The remarks on a subject: how its requirement is attached, unless by `satisfies`, and how it is covered, unless
    that is the same for all.
    """
    if use.how in _ATTACHED:
        yield _ATTACHED[use.how]
    if len(requirement.ways) > 1:
        yield from dict.fromkeys(requirement.in_words(clause.way) for clause in use.clauses)


def chain_rows(overview: Overview) -> Iterator[tuple[HazardRow | ExternalRow, list[str], list[RequirementRow]]]:
    """Hazards, and what other tools keep, each with what is known of it and with the requirements that mitigate or
    refine it.
    """
    rows = {row.key: row for row in overview.requirements}
    for hazard in overview.hazards:
        remarks = [f"severity {hazard.severity}"] if hazard.severity else []
        remarks += [f'source "{source}"' for source in hazard.sources]
        remarks += [f'because "{reason}"' for reason in hazard.reasons]
        yield hazard, remarks, [rows[key] for key in hazard.requirements]
    for external in overview.external:
        remarks = [external.status] if external.status else []
        remarks += [f"{shown_scenario(scenario)}, {scenario.at}" for scenario in external.scenarios]
        yield external, remarks, [rows[key] for key in external.requirements]


def approval_lines(requirement: RequirementRow) -> Iterator[str]:
    """Who has approved a requirement and when, and whether that is outdated."""
    for approval in requirement.approvals:
        yield f"approved by {approval.by} on {approval.on}{'' if approval.of else ', without a fingerprint'}"
    if requirement.state == "suspect":
        yield OUTDATED


def shown_scenario(scenario: VerificationRow) -> str:
    """A scenario as it begins in the file, what came of it, and whether it expects that the requirement is not kept."""
    remarks = (
        scenario.outcome,
        "changed since" if scenario.is_stale else "",
        f"expects it {scenario.expects}" if scenario.expects else "",
    )
    shown = ", ".join(filter(None, remarks))
    return f'scenario "{scenario.id}" ({shown})' if shown else f'scenario "{scenario.id}"'


def state_of(requirement: RequirementRow) -> str:
    """How a requirement is covered, the tests, reports and reviews that it names, the scenarios that verify it, its
    verdict, and whether its approval is outdated.
    """
    by_tools = requirement.verification if "reviewed" not in requirement.ways else ()  # else its way names them
    ways = [f'{way.method} "{way.id}"' for way in by_tools if way.id and way.at is None]
    named = ", ".join((*ways, *map(shown_scenario, requirement.scenarios)))
    is_old = any(clause.is_suspect for clause in requirement.evidence)
    verdict = f"{requirement.verdict} (suspect)" if is_old else requirement.verdict
    outdated = OUTDATED if requirement.state == "suspect" else ""
    parts = (", ".join(requirement.ways_in_words), named, verdict, outdated)
    return "; ".join(part for part in parts if part)


GAPS: Final = {
    "unmitigated": "Hazards without a requirement",
    "unenforced": "Hard requirements that are not enforced everywhere",
    "unmeasured": "Qualities without a requirement",
    "unattached": "Requirements without a node",
    "unjudged": "Requirements without a verdict",
    "not_passed": "Scenarios that have not passed",
    "sourceless": "Requirements without a source",
    "loose": "Clauses without a node",
    "bare_trees": "Trees without any quality",
    "bare_nodes": "Custom leaf nodes without any quality",
}
# The columns of the totals by characteristic.
TOTALS: Final = ("Concerns", "Requirements", "Clauses enforced", "Clauses monitored", "Clauses, texts by people")
NO_LABEL: Final = "(none)"
NOT_RUN: Final = "btq trace runs no scenario, btq test does"
OUTDATED: Final = "approval outdated"
_ATTACHED: Final = {"apply": "by apply", "link": "a link only"}
