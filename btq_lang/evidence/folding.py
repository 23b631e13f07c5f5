"""Remarks on very many logs, in a few lines for people; documents for programs have all of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from btq_lang.evidence.verdicts import EvidenceFile
from btq_lang.util.grouping import grouped
from btq_lang.util.record import replace
from btq_lang.util.text import counted


def folded(lines: Iterable[str]) -> Iterator[str]:
    """The lines; many that differ only in names and numbers are one, with how many more there are."""
    for alike in grouped((_VARYING.sub("#", line), line) for line in lines).values():
        if len(alike) <= _MOST:
            yield from alike
        else:
            yield f"{alike[0]} (and {len(alike) - 1} more like this)"


def folded_sources(sources: Sequence[EvidenceFile]) -> Sequence[EvidenceFile]:
    """The logs; many whose nodes were found in the same way are one."""
    if len(sources) <= _MOST:
        return sources
    alike = grouped(((source.identity, source.joined, source.nodes), source) for source in sources).values()
    return [alike_source for group in alike for alike_source in (group if len(group) <= _MOST else [_joint(group)])]


def _joint(sources: Sequence[EvidenceFile]) -> EvidenceFile:
    first, last = sources[0], sources[-1]
    remarks = [f"{source.file}: {remark}" for source in sources for remark in source.remarks]
    return replace(
        first,
        file=f"{counted(len(sources), 'log')}, {first.file} to {last.file}",
        runs=sum(source.runs for source in sources),
        begin=min((source.begin for source in sources if source.begin is not None), default=None),
        end=max((source.end for source in sources if source.end is not None), default=None),
        remarks=tuple(folded(remarks)),
    )


_MOST: Final = 5  # that are listed one by one
_VARYING: Final = re.compile(r"\S*[\d./\\]\S*")  # words with a number, or of a path
