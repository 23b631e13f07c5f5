"""SuccessIf and FailureIf in the description of a classic requirement: what follows them, and whether it is more
than prose.

One invariant: the result depends only on the text and on the names of nodes.  What it means is for `classic`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Final

from btq_lang.catalog.verbs import COUNTING
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import HEADS
from btq_lang.parser import parse
from btq_lang.syntax.tree import Claim, Path, Requirement, Word
from btq_lang.util.record import Record
from btq_lang.util.text import Span

# How the keywords are spelt, folded; FailuerIf by the original tool.
_KEYWORDS = ("successif", "failureif", "failuerif")


class Constraint(Record):
    """A keyword in a text, and what follows it.

    Attributes:
        keyword: the place of the keyword, counted from the start of the text.
        violates: whether it describes when the requirement is violated.
    """

    keyword: Span
    violates: bool
    text: str


def constraints(word: Word) -> list[Constraint]:
    """What follows each keyword, up to the next one."""
    text = word.text
    if "if" not in text.lower():
        return []
    matches = list(_keyword_pattern().finditer(text))
    ends = [*(match.start() for match in matches), len(text)][1:]
    parts = [(match, text[match.end() : end].lstrip(":").strip()) for match, end in zip(matches, ends, strict=True)]
    return [Constraint(Span(*match.span()), match[0][0] not in "sS", part) for match, part in parts]


def can_be_checked(text: str, is_node_name: Callable[[str], bool]) -> bool:
    """Whether it is a script that the engine takes for a condition, or clauses of a requirement; `it takes at most 5 s`
    is neither, unless there is a node `it`."""
    needed = _nodes_needed(text)
    return needed is not None and all(map(is_node_name, needed))


@lru_cache(1_000)
def _nodes_needed(text: str) -> frozenset[str] | None:
    """The names that must be names of nodes so that it can be checked; None if it cannot."""
    if is_script(text):
        return frozenset()
    words = text.replace(".", " ").split()
    if not words or (words[0] not in HEADS and _VERBS.isdisjoint(words)):
        return None
    parsed = clauses_of(text)
    if parsed is None:
        return None
    subjects = [clause.subject for clause in parsed[0].clauses if isinstance(clause, Claim)]
    return frozenset([name.text for subject in subjects if isinstance(subject, Path) for name in subject.names])


def is_script(text: str) -> bool:
    """Whether the engine takes it for a condition."""
    from btq_lang.syntax.script.check import check_script  # few files have a keyword
    from btq_lang.syntax.script.parser import parse_script

    problems = check_script(parse_script(text), expects_value=True)
    return all(problem.effective_severity is not Severity.ERROR for problem in problems)


def clauses_of(text: str) -> tuple[Requirement, str] | None:
    """A requirement with these clauses, and the text that its offsets count in; None for anything else."""
    whole = f"QualityReq r {' '.join(text.split()).rstrip('.')}\n"
    parsed = parse(whole)
    item = parsed.entries[0].item
    if parsed.diagnostics or len(parsed.entries) > 1 or not isinstance(item, Requirement):
        return None
    says_more = item.parameters or item.quality is not None or item.text is not None
    return (item, whole) if item.clauses and not says_more else None


_VERBS: Final = VERB_WORDS | COUNTING  # some of the latter are verbs before a bound alone


@cache
def _keyword_pattern() -> re.Pattern[str]:
    return re.compile(rf"\b(?:{'|'.join(_KEYWORDS)})\b", re.IGNORECASE)
