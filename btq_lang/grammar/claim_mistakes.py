"""What people write in place of a claim, and the report of it: words of other notations, words that are missing."""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.units import dimension_name, parse_unit
from btq_lang.catalog.verbs import words
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix, write_fix
from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS, bound_follows, followed_ahead, next_head
from btq_lang.grammar.clause_slips import ROBOTS, clause_slip
from btq_lang.grammar.conditions import (
    BOUNDS,
    COMPARISONS,
    HEADS,
    METADATA_HEADS,
    NO_RATE,
    RELATIONS,
    bound_ahead,
    parse_simple,
)
from btq_lang.grammar.cursor import Cursor, shown
from btq_lang.grammar.prose import MODALS, clause_meant, state_meant
from btq_lang.syntax.scan import number_end
from btq_lang.syntax.tokens import NAME, NEWLINE, NUMBER, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import Amount, Path, Subject, Word, quote
from btq_lang.util.spelling import near
from btq_lang.util.text import Span


def report_slip(cursor: Cursor) -> bool:
    """Report that the clause is written otherwise, if it is known how."""
    last = len(cursor.kinds) - 2
    for start in cursor.clause_starts:  # `succeeds` may be read as a clause before `in 30 s`
        if start < cursor.starts[0] or last < 0:
            continue  # of another line
        meant = clause_slip(cursor.text[start : cursor.starts[last] + len(cursor.raws[last])])
        if meant is not None and start + meant.length > cursor.clause_starts[1]:
            written_instead(cursor, Span(start, start + meant.length), meant.clauses, meant.note)
            return True
    return False


def written_instead(cursor: Cursor, span: Span, clauses: tuple[str, ...], note: str) -> None:
    """Report what is written instead of a clause, if it is known; otherwise only the note."""
    if not clauses:
        cursor.complain(span, note)
        return
    fixes = [write_fix(clause, span) for clause in clauses if not _OPEN.search(clause)]
    written = " or ".join(f"`{shown(clause, most=120)}`" for clause in clauses)
    notes = (note,) if note else ()
    meant = Diagnostic("syntax-error", span, f"this clause is written {written}", (), notes, tuple(fixes))
    signs = [each for each in cursor.lexer.problems[cursor.known :] if span.start <= each.span.start < span.end]
    if signs:  # characters that are no token: `±`
        cursor.complain_instead(signs, meant)
    else:
        cursor.report(meant)


def no_verb(cursor: Cursor, subject: Subject) -> None:
    """Report a subject without a verb, or of a misspelt verb that was read as a subject."""
    first = subject.names[0] if isinstance(subject, Path) and len(subject.names) == 1 else None
    is_article = first is not None and first.raw in ARTICLES
    may_be_other = is_article or (first is not None and first.raw in ROBOTS) or not _IN_SLIPS.isdisjoint(cursor.raws)
    if may_be_other and report_slip(cursor):
        cursor.recover()
    elif is_article or is_prose(cursor, first):
        cursor.expected(_A_VERB if is_article else f"a verb after `{first.raw if first else ''}`", (PROSE,))
    elif in_other_words(cursor, subject) or situation(cursor, first):
        cursor.recover()
    elif isinstance(subject, Path) and cursor.raw in HAPPENINGS and followed_ahead(cursor):
        before = Span(subject.span.start + cursor.base, subject.span.start + cursor.base)
        fix = replace_fix("Put `each` before it", before, "each ")
        cursor.complain(cursor.here(), f"expected `each` before `{before_verb(cursor, subject)} {cursor.raw}`", fix)
        cursor.recover()
    elif isinstance(subject, Path) and cursor.kind == NAME and cursor.raw in NO_VERBS:
        cursor.expected(_A_VERB, (NO_VERBS[cursor.raw],))
    elif isinstance(subject, Path) and (cursor.at_word("and") or cursor.at(",")):
        note = "a clause applies to one node; write it for each, or `sum of A, B` for the time of both"
        cursor.expected(_A_VERB, (note,))
    elif first is not None and (first.raw in ("at", "within") or cursor.at("+")) and report_slip(cursor):
        cursor.recover()
    elif first is not None and first.raw == "at" and (fixes := takes_before(cursor, first)):
        cursor.expected(f"a verb before `at {cursor.raw}`", (MEANT["at"],), fixes)
    elif first is not None and first.kind == NAME and (noted := MEANT.get(first.raw) or NO_VERBS.get(first.raw)):
        cursor.expected(f"a verb after `{first.raw}` (takes, succeeds, needs, keeps, …)", (noted,))
    elif (signal := compared(cursor, first)) is not None and report_slip(cursor):
        cursor.recover()
    elif signal is not None:
        start, index = signal.start + cursor.base, cursor.kinds.index(OPERATOR, cursor.index)
        fix = replace_fix("Put `keeps` before it", Span(start, start), "keeps ")
        message = "expected a verb before the condition: `keeps`, `never`, `needs` or `leaves`"
        notes = ("`keeps` holds while the node runs, `needs` when it starts, `leaves` when it has succeeded",)
        cursor.complain(Span(start, cursor.starts[index] + len(cursor.raws[index])), message, fix, notes=notes)
        cursor.recover()
    elif cursor.kind == NAME and (likely := near(cursor.raw, VERB_WORDS, limit=1)):
        cursor.misspelt(cursor.here(), cursor.raw, likely[0])
        cursor.recover()
    elif not isinstance(subject, Path):
        cursor.expected(_A_VERB)
    elif len(subject.names) == 1 and (
        likely := near(subject.names[0].raw, VERB_WORDS | HEADS | METADATA_HEADS, limit=1)
    ):
        cursor.misspelt(subject.span.shifted(cursor.base), subject.names[0].raw, likely[0])
        cursor.recover()
    else:
        name = "/".join(word.raw for word in subject.names)
        note = (
            f"btq reads `{shown(name)}` as the subject of a clause; write a verb after it, or begin with a "
            "clause word: in at least, while, on violation, goal, …"
        )
        if subject.names[0].kind == STRING:
            note = "a requirement has one title, after its name; reasons are written `because …`"
        elif cursor.kind == NAME and cursor.raw in MEANT:
            note = MEANT[cursor.raw]
        elif cursor.kind == STRING:
            note = 'a quality goes after `:` and a title in quotes: QualityReq ID : quality "title"'
        cursor.expected(f"a verb after `{shown(name)}` (takes, succeeds, needs, keeps, …)", (note,))


def compared(cursor: Cursor, first: Word | None) -> Word | None:
    """The signal of a comparison without a verb: the word that was read as the subject, or the one after a subject."""
    index = cursor.index + (cursor.kind == NAME)
    if cursor.kinds[index] != OPERATOR or cursor.raws[index] not in COMPARISONS:
        return None
    if index == cursor.index:
        return first
    is_misspelt_verb = first is not None and near(first.raw, VERB_WORDS, limit=1)
    return Word(NAME, cursor.start(), cursor.raw) if not is_misspelt_verb else None


def is_prose(cursor: Cursor, first: Word | None) -> bool:
    """Whether the word that was read as the subject begins a sentence: `user stops robot within 2 s`."""
    words = [first.raw if first is not None else "", *cursor.raws[cursor.index : cursor.index + 2]]
    are_names = cursor.kinds[cursor.index : cursor.index + 2] == [NAME, NAME] and first is not None
    if not are_names or not words[0][0].islower() or not COMPARISONS.isdisjoint(cursor.raws):
        return False
    is_of_clause = not (_NO_NAMES | VERB_WORDS | MEANT.keys() | NO_VERBS.keys()).isdisjoint(words)
    return not is_of_clause and not near(words[1], VERB_WORDS, limit=1) and words[2] not in _OF_BOUNDS


def in_other_words(cursor: Cursor, subject: Subject) -> bool:
    """Report `must take at most 30 s`, `Go should be reached within 30 s` and `speed must stay below 1 m/s`."""
    is_word = isinstance(subject, Path) and len(subject.names) == 1 and subject.names[0].kind == NAME
    if is_word and verb_in_other_words(cursor, cursor.index - 1, ""):
        return True
    before = before_verb(cursor, subject)
    if verb_in_other_words(cursor, cursor.index, before):
        return True
    for begin in (cursor.index - 1, cursor.index) if is_word else (cursor.index,):
        state = state_meant(cursor.raws, begin + 1) if cursor.kinds[begin] == NAME else None
        if state is not None:
            node = before if begin == cursor.index else ""
            written_as(cursor, begin, state[0], node, f"keeps {cursor.raws[begin]} {state[1]}")
            return True
    return False


def before_verb(cursor: Cursor, subject: Subject | None) -> str:
    """The text of a subject; empty if there is none."""
    if subject is None:
        return ""
    span = subject.span if isinstance(subject, Path) else Span(subject.start, subject.end)
    return cursor.text[span.start + cursor.base : span.end + cursor.base]


def verb_in_other_words(cursor: Cursor, begin: int, subject: str) -> bool:
    """Report `must take`, which begins at a token after the subject."""
    times = [is_time(raw) for kind, raw in zip(cursor.kinds, cursor.raws, strict=True) if kind == QUANTITY]
    meant = clause_meant(cursor.raws, begin, is_time=bool(times) and all(times))
    if meant is not None:
        end, verb = meant
        is_verb = not verb  # after a word like `must`
        written_as(cursor, begin, end + is_verb, subject, verb or cursor.raws[end])
    return meant is not None


def condition_in_other_words(cursor: Cursor, verb: str, subject: Subject | None) -> bool:
    """Report `needs to take` and `never starts more than 2 times`, after the verb."""
    if verb == "never" and cursor.raw in _COUNTED and "than" in cursor.raws:
        return report_slip(cursor)
    return cursor.at_word("to") and verb_in_other_words(cursor, cursor.index - 1, before_verb(cursor, subject))


def written_as(cursor: Cursor, begin: int, end: int, subject: str, words: str) -> None:
    """Report that other words are written in place of those between two tokens, after a subject."""
    span = Span(cursor.starts[begin], cursor.starts[end - 1] + len(cursor.raws[end - 1]))
    tail = cursor.text[span.end : cursor.starts[-1]].strip()
    whole = " ".join(part for part in (subject, words, tail) if part)
    cursor.complain(span, f"this clause is written `{shown(whole)}`", write_fix(words, span))


def situation(cursor: Cursor, first: Word | None) -> bool:
    """Report `unless humans_near`, with the condition that is written there."""
    if first is None or first.kind != NAME or first.raw not in ("unless", "if") or cursor.kind == NEWLINE:
        return False
    if not {"then", "else", "otherwise"}.isdisjoint(cursor.raws) and report_slip(cursor):
        return True
    end = next_head(cursor)
    if end == cursor.index:
        return False
    condition = cursor.text[cursor.here().start : cursor.starts[end - 1] + len(cursor.raws[end - 1])]
    span = Span(first.start + cursor.base, cursor.here().start + len(condition))
    if first.raw == "if":
        note = f"to limit a clause to a situation, write `while {condition}` or `when {condition}`"
        cursor.complain(span, "a clause has no `if`", notes=(note,))
        return True
    joined = any(word in ("and", "or") for word in cursor.raws[cursor.index : end])
    written = f"while not ({condition})" if joined else f"while not {condition}"
    cursor.complain(span, f"this clause is written `{shown(written)}`", write_fix(written, span))
    return True


def every_meant(cursor: Cursor) -> bool:
    """Report `all MoveBase`, and read it as `every`."""
    if cursor.kind != NAME or cursor.raw not in ("all", "each", "any"):
        return False
    if cursor.kinds[cursor.index + 1] != NAME or cursor.raws[cursor.index + 1] in VERB_WORDS:
        return False
    if cursor.raw == "each" and cursor.raws[cursor.index + 1] == "when":
        if not report_slip(cursor):
            cursor.complain(cursor.here(), "expected `is followed by` after `each` and its event", notes=(_REACTION,))
        cursor.recover()
        return True
    bound = cursor.index + 2
    is_bound = cursor.raws[bound] != "/" and cursor.raws[bound] not in VERB_WORDS and bound_follows(cursor, bound)
    if is_bound and "per" in cursor.raws:
        cursor.complain(cursor.here(), NO_RATE)
        cursor.recover()
        return True
    fix = replace_fix(f"Replace `{cursor.raw}` with `every`", cursor.here(), "every", safe="per" not in cursor.raws)
    cursor.complain(cursor.here(), "all nodes of a kind are written `every …`", fix)
    cursor.advance()
    return True


def event_after_condition(cursor: Cursor, first: int) -> bool:
    """Report `near or Dock succeeds`, which begins at a token and whose end is read as a condition, if it is here: a
    condition comes last.
    """
    is_event = cursor.kind == NAME and cursor.raw in HAPPENINGS and cursor.kinds[cursor.index - 1] in (NAME, STRING)
    if not is_event or bound_follows(cursor, cursor.index + 1):
        return False
    words, following = cursor.raws[first : cursor.index], cursor.raws[cursor.index + 1 :]
    is_clause = following[0] == "within" and "after" in following  # `starts within 2 s after …`
    if is_clause or not {"or", "and"}.intersection(words):
        return False
    middle = cursor.index - 1 - words[::-1].index("or") if "or" in words else 0
    event, end = text_between(cursor, middle + 1, cursor.index + 1), cursor.here().end
    fixes: tuple[Fix, ...] = ()
    if first < middle and not {"and", "not"}.intersection(cursor.raws[middle : cursor.index]):
        start = first + (cursor.raws[first] == "when")
        fixes = (write_fix(f"{event} or when {text_between(cursor, start, middle)}", Span(cursor.starts[first], end)),)
    message = "of several events a condition comes last, after `when`: `Dock succeeds or when near`"
    cursor.complain(cursor.here(), message, *fixes)
    cursor.recover()
    return True


def condition_as_event(cursor: Cursor, path: Subject | None, start: int) -> bool:
    """Report `Dock succeeds or near`, whose condition lacks its `when`; `start`: of the condition."""
    is_ended = cursor.kind == NEWLINE or cursor.at_word("is") or cursor.at_word("within")
    if not isinstance(path, Path) or len(path.names) > 1 or not (is_ended or cursor.kind == OPERATOR):
        return False
    if cursor.kind == OPERATOR and cursor.raw not in COMPARISONS:
        return False
    name, begin = path.names[0].raw, start + cursor.base
    fixes = [replace_fix(f"Put `when` before `{name}`", Span(begin, begin), "when ")]
    if is_ended:
        fixes.append(replace_fix(f"Write `{name} succeeds`", path.span.shifted(cursor.base), f"{name} succeeds"))
    message = f"among events a condition comes last, after `when`: `or when {name}`"
    cursor.complain(path.span.shifted(cursor.base), message, *fixes)
    return True


def every_in_event(cursor: Cursor) -> None:
    """Report and skip the first word of `every Spread fails`, where an event is about one node."""
    following = cursor.index + 1
    if not cursor.at_word("every") or cursor.kinds[following] != NAME or cursor.raws[following] in HAPPENINGS:
        return
    fix = replace_fix("Remove `every`", Span(cursor.here().start, cursor.starts[following]), "")
    note = "for any of several nodes write `X fails or Y fails`"
    cursor.complain(cursor.here(), "an event is about one node, without `every`", fix, notes=(note,))
    cursor.advance()


def blank_in_path(cursor: Cursor, path: Subject | None, follow: frozenset[str]) -> bool:
    """Report `Inspect Dock succeeds`, where a path is written `Inspect/Dock`, and skip the rest."""
    index = cursor.index
    while cursor.kinds[index] in (NAME, STRING) and not (cursor.kinds[index] == NAME and cursor.raws[index] in follow):
        index += 1
    names = cursor.raws[cursor.index : index]
    is_path = isinstance(path, Path) and path.names[0].raw not in MEANT and NO_VERBS.keys().isdisjoint(names)
    if not names or not is_path or _NO_NAMES.intersection(names) or cursor.raws[index] not in follow:
        return False
    if report_slip(cursor):
        return False
    start = path.span.start + cursor.base if isinstance(path, Path) else 0
    end = cursor.starts[index - 1] + len(cursor.raws[index - 1])
    written = "/".join((cursor.text[start : cursor.last_end() + cursor.base], *names))
    message = f"a path is written with `/`: `{shown(written)}`"
    notes: tuple[str, ...] = (f"a name of several words goes in quotes: {quote(cursor.text[start:end])}",)
    notes += (PROSE,) if cursor.text[start].islower() else ()
    cursor.complain(Span(start, end), message, write_fix(written, Span(start, end)), notes=notes)
    cursor.go_to(index)
    return True


def no_within(cursor: Cursor) -> None:
    """Report `succeeds 30 s` and `succeeds 98 %`."""
    is_deadline = is_time(cursor.raw)
    note = "a deadline is written `within 30 s`, a probability `in at least 98 % of runs`"
    cursor.expected("`within`, or the end of the line", (note,), (cursor.put_before("within"),) if is_deadline else ())


def signal_last(cursor: Cursor, verb: str) -> bool:
    """Report `leaves at least 3 % battery`, whose signal goes first."""
    bound = bound_ahead(cursor) if cursor.kind == NAME else None
    length, relation = bound or (0, ("at", "least"))
    value = cursor.index + length
    if cursor.kinds[value] not in (QUANTITY, NUMBER):
        return False
    signal = value + (2 if cursor.raws[value + 1] == "of" else 1)
    if cursor.kinds[signal] != NAME or cursor.raws[signal] in _NO_NAMES:
        return False
    meant = f"{cursor.raws[signal]} {RELATIONS[relation]} {cursor.raws[value]}"
    span = Span(cursor.here().start, cursor.starts[signal] + len(cursor.raws[signal]))
    fixes = (write_fix(meant, span),) if bound else ()
    cursor.expected("a condition, which begins with its signal", (f"write `{verb} {meant}`",), fixes)
    return True


def takes_before(cursor: Cursor, first: Word) -> tuple[Fix, ...]:
    """The fix for `at most 30 s`, which lacks its verb."""
    value = cursor.index + 1
    is_bound = ("at", cursor.raw) in RELATIONS and cursor.kinds[value] == QUANTITY and is_time(cursor.raws[value])
    start = first.start + cursor.base
    return (replace_fix("Put `takes` before it", Span(start, start), "takes "),) if is_bound else ()


def no_relation(cursor: Cursor) -> None:
    """Report a bound without its first words."""
    if cursor.at_word("on") and report_slip(cursor):
        cursor.recover()
        return
    is_value = cursor.kind in (QUANTITY, NUMBER)
    note = f"write the kind of bound before the value: `at most {cursor.raw if is_value else '30 s'}`"
    fixes: tuple[Fix, ...] = ()
    if is_value and cursor.raws[cursor.index + 1] in ("-", "to"):
        note = "a range is written `between 10 s and 20 s`"
    elif cursor.kind == QUANTITY and cursor.raws[cursor.index - 1] in _OF_DURATIONS:
        fixes = (cursor.put_before("at most"),)
    cursor.expected("a bound: at most, at least, less than, more than or between", (note,), fixes)


def choice_in_other_words(cursor: Cursor) -> Amount | None:
    """Report `low ? 60 s : 30 s`, as in C++, and `if low then 60 s else 30 s`; the first of the values."""
    begin, raws = cursor.index, cursor.raws
    has_if = cursor.at_word("if")
    middle, last = ("then", "else") if has_if else ("?", ":")
    first = raws.index(middle, begin) if middle in raws[begin:] else begin
    second = end_of_simple(cursor, first + 1)
    third = end_of_simple(cursor, second + 1) if raws[second] == last else second
    condition, note = text_between(cursor, begin + has_if, first), f"a choice is written `{_A_CHOICE}`"
    if not condition or third <= second + 1:
        cursor.expected("a value", (note,))
        return None
    span = Span(cursor.here().start, cursor.starts[third - 1] + len(raws[third - 1]))
    written = f"{text_between(cursor, first + 1, second)} if {condition} else {text_between(cursor, second + 1, third)}"
    cursor.complain(span, f"a choice is written `{shown(written)}`", write_fix(written, span))
    cursor.go_to(first + 1)
    value = parse_simple(cursor)
    cursor.go_to(third)
    return value


def end_of_simple(cursor: Cursor, index: int) -> int:
    """The token after the value that begins at a token; the same token if none does."""
    begin = index + (cursor.raws[index : index + 1] == ["-"])
    is_value = begin < len(cursor.kinds) and cursor.kinds[begin] in (QUANTITY, NUMBER, NAME)
    return begin + 1 if is_value else min(index, len(cursor.kinds) - 1)


def text_between(cursor: Cursor, begin: int, end: int) -> str:
    """The text of some tokens."""
    return cursor.text[cursor.starts[begin] : cursor.starts[end - 1] + len(cursor.raws[end - 1])] if begin < end else ""


def per_unit(cursor: Cursor) -> None:
    """Report a rate per a unit of time, `/ h` or the rest of `per h`, and skip what follows."""
    has_sign = cursor.at("/")
    start, last = cursor.here().start, cursor.index + has_sign
    unit = cursor.raws[last]
    end = cursor.starts[last] + len(unit)
    blank = cursor.base + cursor.last_end() if has_sign else start
    time = f" per 1 {unit}" if has_sign else f"1 {unit}"
    fix = replace_fix(f"Write `per 1 {unit}`", Span(blank, end), time, safe=True)
    cursor.complain(Span(start, end), f"a failure rate is per a time: `per 1 {unit}`", fix)
    cursor.recover()


def is_time(raw: str) -> bool:
    """Whether a quantity is a time: `30 s`."""
    return is_unit_of_time(raw[number_end(raw, 0) :].strip())


def is_unit_of_time(text: str) -> bool:
    unit = parse_unit(text)
    return unit is not None and dimension_name(unit) == "time"


ARTICLES: Final = frozenset(("the", "The", "an", "An"))
_COUNTED: Final = HAPPENINGS | {"runs"}
_IN_SLIPS: Final = frozenset(("after", "than"))
PROSE: Final = (
    "a clause begins with a node, with `mission` or with its verb; what people do is prose: the requirement's title, "
    'with `verified by test "…"`'
)
_REACTION: Final = "write `each when near is followed by speed <= 0.01 m/s within 1 s`"
_OF_BOUNDS: Final = frozenset(word for phrase in BOUNDS for word in phrase)
QUALITY_IN_HEAD: Final = "a requirement's quality goes after its name: `QualityReq fast : reliability`"
NO_VERBS: Final = {  # what else people write before or as a verb
    **dict.fromkeys(MODALS, "a clause begins with its verb, without such a word: `takes at most 30 s`"),
    **dict.fromkeys(("finishes", "ends", "completes"), "write `succeeds within 30 s`, or `takes at most 30 s`"),
    "fails": "`fails at most 3 per run` limits the failures, `succeeds` demands that the node does not fail",
    **dict.fromkeys(("stays", "remains", "is"), "what holds while a node runs is written `keeps battery >= 15 %`"),
}
MEANT: Final = {  # by the word that is read as a node before a verb
    "at": "a bound goes after its verb, `takes at most 3 s`; a probability is written `in at least 95 % of runs`",
    **dict.fromkeys(("violation", "otherwise"), "write `on violation fail`"),
    **dict.fromkeys(("max", "maximum"), "an upper bound goes after its verb: `takes at most 30 s`"),
    **dict.fromkeys(("min", "minimum"), "a lower bound goes after its verb: `takes at least 1 s`"),
    "within": "write `succeeds within 30 s`, or `takes at most 30 s`",
    "if": "to limit a clause to a situation, add `while humans_near` or `when fragile`",
    "unless": "write `while not humans_near`",
    "after": "write `follows Look succeeds`, `starts within 2 s after Look succeeds`, or "
    "`each Look succeeds is followed by Pick starts`",
    **dict.fromkeys(("whenever", "once"), "write `each Pick fails is followed by Recover starts within 5 s`"),
    "before": "write `from Pick starts to Place succeeds takes at most 45 s`, or "
    "`mission never node Place from mission starts until Pick succeeds`",
    "between": "a range is written `keeps 0 N <= force <= 3 N`",
    "always": "write `keeps battery >= 15 %`",
    "not": "write `never lamp_on`, or `keeps not lamp_on`",
    "else": "a choice of values goes in brackets: `keeps speed <= (0.3 m/s if near else 0.8 m/s)`",
    "quality": QUALITY_IN_HEAD,
    "severity": "a hazard has a `severity`, a requirement a `priority`",
    **dict.fromkeys(
        ("title", "description", "text"), 'a requirement has one title, after its name: `QualityReq fast "in time"`'
    ),
}
_NO_NAMES: Final = HEADS.union(
    ("and", "or", "not", "if", "else", "is", "to", "until", "of", "by", "per", "at", "within", "after")
)
_OPEN: Final = re.compile("<[a-z]+>")  # what is left to choose in a clause
_A_CHOICE: Final = "60 s if battery_low else 30 s"
_A_VERB: Final = "a verb: takes, succeeds, needs, keeps, …"
_OF_DURATIONS: Final = words(operands=("duration",))
