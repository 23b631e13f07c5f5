"""Markdown, for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.evidence.folding import folded_sources
from btq_lang.evidence.meanings import SUSPECT
from btq_lang.evidence.node_rows import node_rows
from btq_lang.evidence.sentences import headline, result
from btq_lang.evidence.verdicts import WORST_FIRST, MissionVerdicts, VerdictReport
from btq_lang.render.gfm import code, escaped, table
from btq_lang.util.text import counted


def render(report: VerdictReport) -> str:
    """The verdicts of each mission, and what to look at."""
    return "\n\n".join("\n".join(_lines(mission)) for mission in report.missions) + "\n"


def _lines(mission: MissionVerdicts) -> Iterator[str]:
    verdicts = [requirement.verdict for requirement in mission.requirements]
    counts = [f"{verdicts.count(verdict)} {verdict}" for verdict in WORST_FIRST if verdict in verdicts]
    yield f"### {escaped(mission.name)}: {', '.join(counts) or 'no requirement to judge'}"
    yield ""
    files = ", ".join(code(source.file) for source in folded_sources(mission.sources))
    outcomes = ", ".join(f"{number} {outcome}" for outcome, number in mission.outcomes)
    yield f"{counted(mission.runs, 'run')} in {files}{': ' if outcomes else ''}{outcomes}"
    if not verdicts:
        if mission.nodes:
            heads, rows = node_rows(mission.nodes)
            yield ""
            yield from table(heads, [[code(path), *numbers] for path, *numbers in rows], numbers_from=1)
        return
    yield ""
    clauses = [(requirement, clause) for requirement in mission.requirements for clause in requirement.clauses]
    clauses.sort(key=lambda pair: WORST_FIRST.index(pair[1].verdict))
    rows = [
        (
            f"**{clause.verdict}**" if clause.verdict == WORST_FIRST[0] else clause.verdict,
            "<br>".join(filter(None, (f"**{escaped(requirement.id)}**", escaped(requirement.title)))),
            "<br>".join(code(text) for text in (clause.text, clause.path) if text),
            escaped(result(clause)) + (f"<br>{SUSPECT}" if requirement.is_suspect else ""),
        )
        for requirement, clause in clauses
    ]
    yield from table(("Verdict", "Requirement", "Clause", "Result"), rows)
    headlines = [headline(clause, mission.medians) for _, clause in clauses if clause.verdict == WORST_FIRST[0]]
    if headlines:
        yield from ("", "What to look at:", "")
        yield from (f"* {escaped(line)}" for line in headlines)
