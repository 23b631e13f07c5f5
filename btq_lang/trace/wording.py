"""Sentences of an overview that several writers print."""

from __future__ import annotations

from typing import Final

from btq_lang.trace.overview import Overview, QualityRow, RequirementRow, Use
from btq_lang.util.text import counted


def summary(overview: Overview) -> str:
    """All counts, in a sentence."""
    ways = {way: sum(getattr(total, way) for total in overview.totals) for way in ("enforced", "monitored", "reviewed")}
    ways["without a node"] = len(overview.loose)
    held = ", ".join(f"{number} {way}" for way, number in ways.items() if number)
    sentence = f"{counted(len(overview.requirements), 'requirement')}"
    sentence += f" ({counted(sum(ways.values()), 'clause')}: {held})" if held else ""
    if hard := len(overview.unenforced):
        sentence += f", {hard} of them hard (on violation fail or halt) and not enforced everywhere"
    sentence += f", {counted(len(overview.qualities), 'quality', 'qualities')}"
    skills = overview.coverage()
    if not sum(skills.values()):
        return f"{sentence}."
    of = f"{sentence}; of {counted(sum(skills.values()), 'custom leaf node')}, {skills['own']}"
    of += " carries" if skills["own"] == 1 else " carry"
    return f"{of} a quality or a requirement, {skills['above']} only through a node above, {skills['none']} not at all."


def shown_quality(quality: QualityRow) -> str:
    """A quality's name, with the model's name if that differs."""
    known = quality.id
    return quality.name if known is None or known.endswith(quality.name) else f"{quality.name} ({known})"


def remarks(requirement: RequirementRow, use: Use) -> str:
    """The remarks on a subject: how its requirement is attached, unless by `satisfies`, and how it is covered, unless
    that is the same for all.
    """
    parts = [_ATTACHED[use.how]]
    if "," in requirement.way:
        parts.append(", ".join(dict.fromkeys(clause.way for clause in use.clauses)))
    return ", ".join(filter(None, parts))


GAPS: Final = {
    "unenforced": "Hard requirements that are not enforced everywhere",
    "unmeasured": "Qualities without a requirement",
    "unattached": "Requirements without a node",
    "loose": "Clauses without a node",
    "bare_trees": "Trees without any quality",
    "bare_nodes": "Custom leaf nodes without any quality",
}
_ATTACHED: Final = {"subject": "", "satisfies": "", "apply": "by apply", "link": "a link only"}
