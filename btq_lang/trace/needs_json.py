"""The needs.json of sphinx-needs, which its `needimport` and `needs_external_needs` read, and `btq check` too.

A requirement is a need of type `req`; its content is a list of its clauses, its tags are its qualities, and its status
is the worst verdict.
"""

from __future__ import annotations

import json

from btq_lang.trace.overview import Overview, RequirementRow
from btq_lang.util.version import __version__


def render(overview: Overview) -> str:
    """The requirements as needs of the only version, in their order."""
    needs = {requirement.name: _need(requirement) for requirement in overview.requirements}
    version = {"creator": {"program": "btq", "version": __version__}, "needs": needs, "needs_amount": len(needs)}
    return json.dumps({"current_version": "", "project": "btq", "versions": {"": version}}, indent=1) + "\n"


def _need(requirement: RequirementRow) -> dict[str, object]:
    return {
        "id": requirement.name,
        "type": "req",
        "title": requirement.title or requirement.name,
        "content": "\n".join(f"* ``{clause}``" for clause in requirement.clauses),
        "status": requirement.evidence[0].verdict if requirement.evidence else None,
        "tags": [requirement.quality] if requirement.quality is not None else [],
        "docname": requirement.at.path,
        "lineno": requirement.at.line,
    }
