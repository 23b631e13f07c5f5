"""The part of the parser that reads clauses: a claim, or what limits, weighs or explains the claims of a requirement.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import measured
from btq_lang.diagnostics.model import Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.claim_mistakes import QUALITY_IN_HEAD, is_time, report_slip
from btq_lang.grammar.claim_words import VERB_WORDS, is_verb_ahead
from btq_lang.grammar.claims import parse_bounded, parse_claim, parse_event
from btq_lang.grammar.clause_slips import OF_SEASONS, SEASONS
from btq_lang.grammar.conditions import HEADS, METADATA_HEADS, SUBJECT_HEADS, bound_ahead, parse_cond
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.metadata import begins_metadata, list_goes_on, parse_metadata, parse_text
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.suggestions import unknown_unit
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Assuming,
    Average,
    Because,
    Clause,
    Confidence,
    FromUntil,
    Goal,
    How,
    Odds,
    OnViolation,
    ScopeClause,
    Way,
    Window,
    Word,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

EXPERIMENTS: Final = frozenset(("activations", "runs"))
COUNTED: Final = ("activations", "runs", "occurrences")  # by odds
AVERAGE: Final = "average"
TIME: Final = "time"  # a share of it, rather than of experiments
ACTIONS: Final = ("fail", "halt", "warn", "log")
METHODS: Final = ("monitor", "analysis", "test", "review")
ENDS_CLAUSES: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "QualityReq", "Quality"))


def parse_clauses(cursor: Cursor, at_least_one: bool = False) -> tuple[Clause, ...]:
    """{ Clause }, to the end of the line or of the brackets"""
    clauses: list[Clause] = []
    while cursor.kind == NAME or cursor.kind == STRING:
        following = cursor.index + 1
        if cursor.kind == NAME and cursor.raw in ENDS_CLAUSES and cursor.raw not in HEADS:
            break
        if cursor.group and cursor.is_operator(following, "="):
            break
        cursor.clause_starts = cursor.clause_starts[1], cursor.starts[cursor.index]
        clause = parse_clause(cursor)
        if clause is None:
            return tuple(clauses)
        clauses.append(clause)
    if at_least_one and not clauses and cursor.kind == OPERATOR and cursor.raw in ("<=", "<", ">=", ">"):
        bare_bound(cursor)
    elif at_least_one and not clauses:
        cursor.expected(_A_CLAUSE, (QUALITY_IN_HEAD,) if cursor.at_word("satisfices") else ())
    return tuple(clauses)


def parse_clause(cursor: Cursor) -> Clause | None:
    """Clause = Claim | Scope | FromUntil | Assuming | Average | Odds | Confidence | Window | OnViolation | Goal | …"""
    word = cursor.raw if cursor.kind == NAME else ""
    if word in VERB_WORDS or word in SUBJECT_HEADS:
        return parse_from_until(cursor) if word == "from" and until_ahead(cursor) else parse_claim(cursor)
    if word == "while" or word == "when":
        return parse_scope(cursor)
    if word == "in" or word == "with":
        return parse_odds(cursor)
    if word == "assuming" and is_assumption(cursor):
        return parse_assuming(cursor)
    if word == "confidence":
        return parse_confidence(cursor)
    if word == "over":
        return parse_window(cursor)
    if word == "on" and cursor.is_word(cursor.index + 1, AVERAGE):
        return parse_average(cursor)
    if word == "on" or word == "on_violation":
        return parse_on_violation(cursor)
    if word == "goal":
        return parse_goal(cursor)
    if word == "because":
        return parse_because(cursor)
    if word == "verified":
        return parse_how(cursor)
    if word in METADATA_HEADS and begins_metadata(cursor):
        return parse_metadata(cursor)
    if word.lower() in _NOT_IN_BTQ and is_other_clause(cursor):
        other_clause(cursor, _NOT_IN_BTQ[word.lower()])
        return None
    if (cursor.lost_quote() or cursor.wrong_unit()) and not is_verb_ahead(cursor, 1):
        cursor.expected(_A_CLAUSE)
        return None
    if is_no_time(cursor):
        start = cursor.starts[cursor.index]
        cursor.report(unknown_unit(cursor.text, start, start + len(cursor.raw)))
        cursor.advance()
        return parse_clause(cursor) if cursor.kind == NAME else None
    return parse_claim(cursor)


def parse_scope(cursor: Cursor) -> ScopeClause:
    """Scope = ( "while" | "when" ) Cond"""
    word = cursor.take()
    cursor.skip_sign(":")
    condition = parse_cond(cursor)
    return ScopeClause(word.start, cursor.last_end(), word, condition)


def parse_assuming(cursor: Cursor) -> Assuming:
    """ "assuming" Cond"""
    start = cursor.take().start
    cursor.skip_sign(":")
    condition = parse_cond(cursor)
    return Assuming(start, cursor.last_end(), condition)


def parse_from_until(cursor: Cursor) -> FromUntil:
    """FromUntil = "from" Event "until" Event"""
    start = cursor.take().start
    first = parse_event(cursor)
    last = parse_event(cursor) if first is not None and cursor.expect_word("until") else None
    if first is None:
        cursor.recover()
    return FromUntil(start, cursor.last_end(), first, last)


def parse_average(cursor: Cursor) -> Average:
    """ "on" "average" """
    start = cursor.take().start
    cursor.advance()
    return Average(start, cursor.last_end())


def parse_odds(cursor: Cursor) -> Odds:
    """ "in" "at" "least" QUANTITY "of" Counted | "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" Counted ]"""
    start = cursor.start()
    return parse_share(cursor, start) if cursor.accept_word("in") else parse_probability(cursor, start)


def parse_share(cursor: Cursor, start: int) -> Odds:
    """ "at" "least" QUANTITY "of" Counted"""
    value: Word | None = None
    experiments = None
    if cursor.kind == QUANTITY:
        if not report_slip(cursor):
            message = f"a probability is written `in at least {cursor.raw}`"
            cursor.complain(cursor.here(), message, cursor.put_before("at least"))
        value = cursor.take()
    elif cursor.kind == NUMBER:
        value = parse_percentage(cursor, "at least 98 %", "at least ")
    elif cursor.expect_word("at") and cursor.expect_word("least"):
        value = parse_percentage(cursor, "98 %")
    if value is not None and cursor.expect_word("of", forgotten=cursor.raw in COUNTED):
        experiments = parse_counted(cursor)
    return Odds(start, cursor.last_end(), ">=", value, experiments)


def parse_probability(cursor: Cursor, start: int) -> Odds:
    """ "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" Counted ]"""
    relation = ">="
    value: Word | None = None
    experiments = None
    cursor.advance()
    if cursor.kind == QUANTITY:
        value = after_missing(cursor, "probability >=")
    elif cursor.expect_word("probability"):
        if cursor.at(">=") or cursor.at(">"):
            relation = cursor.raw
            cursor.advance()
            value = parse_percentage(cursor, "98 %")
        elif cursor.kind == QUANTITY:
            value = after_missing(cursor, ">=")
        else:
            fixes: tuple[Fix, ...] = ()
            if cursor.kind == NUMBER and 0 < float(cursor.raw) <= 1:
                written = f">= {float(cursor.raw) * 100:.10g} %"
                fixes = (write_fix(written, cursor.here()),)
            cursor.expected("`>=` or `>` and a percentage", (), fixes)
    if value is not None and cursor.accept_word("of"):
        experiments = parse_counted(cursor)
    return Odds(start, cursor.last_end(), relation, value, experiments)


def parse_confidence(cursor: Cursor) -> Confidence:
    """ "confidence" QUANTITY"""
    start = cursor.take().start
    value = parse_percentage(cursor, "95 %")
    return Confidence(start, cursor.last_end(), value)


def parse_window(cursor: Cursor) -> Window:
    """ "over" "last" ( NUMBER Experiments | QUANTITY )"""
    start = cursor.take().start
    cursor.expect_word("last")
    size = experiments = None
    if cursor.kind == QUANTITY:
        size = cursor.take()
    elif cursor.kind == NUMBER:
        size = cursor.take()
        experiments = parse_experiments(cursor)
    else:
        cursor.expected("a number of runs or activations, or a duration")
    return Window(start, cursor.last_end(), size, experiments)


def parse_on_violation(cursor: Cursor) -> OnViolation:
    """ "on" "violation" ( "fail" | "halt" | "warn" | "log" )"""
    start = cursor.start()
    if cursor.at_word("on_violation"):
        fix = write_fix("on violation", cursor.here(), safe=True)
        cursor.complain(cursor.here(), "expected `on violation`, found `on_violation`", fix)
        cursor.advance()
    else:
        cursor.advance()
        if not cursor.accept_word("violation"):
            no_violation(cursor)
    cursor.skip_sign("=")
    action = parse_one_of(cursor, ACTIONS)
    return OnViolation(start, cursor.last_end(), action)


def parse_goal(cursor: Cursor) -> Goal:
    """ "goal" Bounded"""
    start = cursor.take().start
    skip_bound_of_goal(cursor)
    value = parse_bounded(cursor)
    return Goal(start, cursor.last_end(), value)


def parse_because(cursor: Cursor) -> Because:
    """ "because" STRING"""
    start = cursor.take().start
    text = parse_text(cursor, "the reason")
    return Because(start, cursor.last_end(), text)


def parse_how(cursor: Cursor) -> How:
    """ "verified" "by" Way { "," Way }"""
    start = cursor.take().start
    cursor.expect_word("by")
    ways = cursor.listed(parse_way, ways_go_on)
    return How(start, cursor.last_end(), ways)


def parse_way(cursor: Cursor) -> Way | None:
    """( "monitor" | "analysis" | "test" | "review" ) [ STRING ]"""
    start = cursor.start()
    notes = (_WAYS,) if cursor.kind == NAME and cursor.raw in _DEMONSTRATED else ()
    method = parse_one_of(cursor, METHODS, notes)
    if is_bare_id(cursor):
        cursor.complain(cursor.here(), "the ID of a test or a report goes in quotes", cursor.put_in_quotes())
        cursor.advance()
    identifier = cursor.take() if cursor.kind == STRING else None
    return Way(start, cursor.last_end(), method, identifier) if method is not None else None


def parse_counted(cursor: Cursor) -> Word | None:
    """ "activations" | "runs" | "occurrences" | "time"; an article before it is reported"""
    following = cursor.index + 1
    if cursor.kind == NAME and cursor.raw in _ARTICLES and cursor.is_word(following, TIME):
        span = Span(cursor.here().start, cursor.starts[following] + len(TIME))
        cursor.complain(span, f"expected `{TIME}`, found `{cursor.raw} {TIME}`", write_fix(TIME, span, safe=True))
        cursor.advance()
    if cursor.kind == NAME and cursor.raw in SEASONS:
        cursor.expected("activations, runs, occurrences or time", (OF_SEASONS,))
        return None
    return parse_one_of(cursor, (*COUNTED, TIME))


def parse_experiments(cursor: Cursor) -> Word | None:
    """ "activations" | "runs" """
    return parse_one_of(cursor, _EXPERIMENTS)


def parse_percentage(cursor: Cursor, example: str, before: str = "") -> Word | None:
    """QUANTITY; `before`: the words that a fix puts before it"""
    fixes: tuple[Fix, ...] = ()
    if cursor.kind == NUMBER:
        share, span = float(cursor.raw), cursor.here()
        percent = f"{share * 100:.10g} %" if 0 < share <= 1 else f"{cursor.raw} %"
        whole = cursor.index + 2
        if cursor.raws[cursor.index + 1] == "of" and cursor.kinds[whole] == NUMBER and float(cursor.raws[whole]) > 0:
            percent = f"{share * 100 / float(cursor.raws[whole]):.10g} % of"
            span = Span(span.start, cursor.starts[whole] + len(cursor.raws[whole]))
        fixes = (write_fix(before + percent, span),)
    if cursor.kind == QUANTITY:
        return cursor.take()
    cursor.expected(f"a percentage: {example}", (), fixes)
    return None


def parse_one_of(cursor: Cursor, words: tuple[str, ...], notes: tuple[str, ...] = ()) -> Word | None:
    """One of some words; `notes`: on another one in its place"""
    cursor.skip_sign(":")
    if cursor.kind == NAME and cursor.raw in words:
        return cursor.take()
    what = f"{', '.join(words[:-1])} or {words[-1]}"
    meant = near(cursor.raw, words, limit=1) or tuple(word for word in words if cursor.raw.startswith(word))
    meant = meant or tuple(word for word in _OTHER_WORDS.get(cursor.raw, ()) if word in words)
    if cursor.kind != NAME or not meant:
        return cursor.missing_word(what)
    fixes = tuple(replace_fix(f"Replace `{cursor.raw}` with `{word}`", cursor.here(), word) for word in meant)
    cursor.complain(cursor.here(), f"expected {what}, found {cursor.found()}", *fixes, notes=notes)
    cursor.advance()
    return None


# ---- what productions ask and report ----


def ways_go_on(cursor: Cursor) -> bool:
    """Skip the comma between ways to verify; where it may belong to `satisfies`, only before a way with an ID."""
    following = cursor.index + 1
    if cursor.at(",") and cursor.raws[following] in METHODS and cursor.kinds[following + 1] == STRING:
        return cursor.accept(",")
    return list_goes_on(cursor)


def is_bare_id(cursor: Cursor) -> bool:
    """Whether the current word ends its clause and begins no other one."""
    if cursor.kind != NAME or cursor.raw in VERB_WORDS or cursor.raw in ENDS_CLAUSES:
        return False
    return cursor.kinds[cursor.index + 1] == NEWLINE or cursor.raws[cursor.index + 1] == ","


def is_assumption(cursor: Cursor) -> bool:
    """Whether `assuming` begins a clause, and is not the subject of one."""
    return not (is_verb_ahead(cursor, 1) or cursor.is_operator(cursor.index + 1, "/"))


def skip_bound_of_goal(cursor: Cursor) -> None:
    """Report and skip the words of a bound after `goal`: `goal at most 30 s`."""
    length, _ = bound_ahead(cursor) or (0, None)
    value = cursor.index + length
    if length and cursor.kinds[value] in (QUANTITY, NUMBER):
        span = Span(cursor.here().start, cursor.starts[value])
        words = cursor.text[span.start : span.end].strip()
        message = f"a goal is a value: `goal {cursor.raws[value]}`"
        cursor.complain(Span(span.start, span.start + len(words)), message, replace_fix(f"Remove `{words}`", span, ""))
        cursor.go_to(value)


def until_ahead(cursor: Cursor) -> bool:
    """Whether the first event after `from` is followed by `until`, not by `to`."""
    kinds, raws = cursor.kinds, cursor.raws
    for index in range(cursor.index + 2, len(raws) - 1):
        if kinds[index] == NAME and raws[index] in ("to", "until"):
            before = index - 1
            if kinds[before] != OPERATOR and raws[before] not in _BEFORE_OPERANDS:
                return raws[index] == "until"
    return False


def is_other_clause(cursor: Cursor) -> bool:
    """Whether the current word, of other notations, begins a clause of them and is not the subject of one."""
    following = cursor.index + 1
    if cursor.kinds[following] == NAME and cursor.raws[following] in VERB_WORDS:
        return False
    return cursor.kinds[following] in (NAME, STRING, NUMBER, QUANTITY) or cursor.raws[following] in (":", "=")


def other_clause(cursor: Cursor, nearest: str) -> None:
    """Report a clause of another notation, with the nearest of this one."""
    word, value = cursor.here(), cursor.index + 1 + (cursor.raws[cursor.index + 1] in (":", "="))
    fixes: tuple[Fix, ...] = ()
    if nearest in (_BECAUSE, _SOURCE) and cursor.kinds[value] == STRING:
        head = "because" if nearest == _BECAUSE else "source"
        fixes = (replace_fix(f"Write `{head}`", Span(word.start, cursor.starts[value]), f"{head} "),)
    elif (
        nearest == _TITLE and cursor.title_at >= 0 and cursor.index == 0 and cursor.kinds[value : value + 2] == _STRING
    ):
        moved = FixEdit(Place(Span(cursor.title_at, cursor.title_at)), f" {cursor.raws[value]}")
        line = Span(line_start(cursor.text, 0, word.start), cursor.lexer.position)
        fixes = (Fix("Move it after the name", (moved, FixEdit(Place(line), ""))),)
    elif nearest == _COMMENT and cursor.index == 0:
        fixes = (replace_fix("Write it as a comment", Span(word.start, word.start), "# "),)
    cursor.complain(word, f"`{cursor.raw}` is not in btq; nearest is {nearest}", *fixes)
    cursor.recover()


def no_violation(cursor: Cursor) -> None:
    """Report that `violation` is missing, and skip the word in its place: `on failure fail`."""
    following = cursor.index + 1
    if cursor.kind == NAME and cursor.kinds[following] == NAME and cursor.raws[following] in ACTIONS:
        fix = replace_fix(f"Replace `{cursor.raw}` with `violation`", cursor.here(), "violation")
        cursor.complain(cursor.here(), f"expected `violation`, found `{cursor.raw}`", fix)
        cursor.advance()
    elif cursor.kind == NAME and cursor.raw in ACTIONS:
        cursor.expect_word("violation", forgotten=True)
    else:
        cursor.expected("`violation`", (_ON_VIOLATION,))


def after_missing(cursor: Cursor, words: str) -> Word:
    """Read the current percentage; report that `words` are missing before it."""
    message = f"a probability is written `with probability >= {cursor.raw}`"
    cursor.complain(cursor.here(), message, cursor.put_before(words))
    return cursor.take()


def bare_bound(cursor: Cursor) -> None:
    """Report `<= 30 s` without a verb."""
    sign, value = cursor.raw, cursor.index + 1
    bound = {"<=": "at most", "<": "less than", ">=": "at least", ">": "more than"}.get(sign)
    fixes: tuple[Fix, ...] = ()
    if bound is not None and cursor.kinds[value] == QUANTITY and is_time(cursor.raws[value]):
        written = f"takes {bound} {cursor.raws[value]}"
        span = Span(cursor.here().start, cursor.starts[value] + len(cursor.raws[value]))
        fixes = (write_fix(written, span),)
    cursor.expected(_A_CLAUSE, ("a bound goes after its verb: `takes at most 30 s`",), fixes)


def is_no_time(cursor: Cursor) -> bool:
    """Whether a number is followed by a word that can only be a wrong unit of time."""
    if cursor.kind != NAME or cursor.index == 0 or cursor.kinds[cursor.index - 1] != NUMBER:
        return False
    following = cursor.index + 1
    ends = cursor.kinds[following] in (NEWLINE, CLOSE) or (
        cursor.kinds[following] == NAME and cursor.raws[following] in HEADS
    )
    is_misspelt = near(cursor.raw, VERB_WORDS | HEADS, limit=1)
    return ends and not is_misspelt and measured(cursor.raws[: cursor.index]) == "s"


_EXPERIMENTS: Final = tuple(sorted(EXPERIMENTS))
_ARTICLES: Final = ("the", "its", "that")
_STRING: Final = [STRING, NEWLINE]
_BEFORE_OPERANDS: Final = ("when", "and", "or", "not", "node", "(")
_ON_VIOLATION: Final = (
    "`on violation` is followed by fail, halt, warn or log; to try again, put a Retry around the node"
)
_DEMONSTRATED: Final = frozenset(("demonstration", "inspection", "trial", "demo"))
_WAYS: Final = 'a demonstration or a trial is a `test "D-1"`, an inspection a `review "I-1"`'
_OTHER_WORDS: Final = {  # for actions and methods
    **dict.fromkeys(("stop", "abort"), ("halt", "fail")),
    **dict.fromkeys(("alert", "notify", "report"), ("warn", "log")),
    "inspection": ("review",),
    **dict.fromkeys(_DEMONSTRATED - {"inspection"}, ("test",)),
    **dict.fromkeys(("simulation", "proof", "calculation"), ("analysis", "test")),
}
_A_CLAUSE: Final = "a clause: takes, keeps, in at least, on violation, …"
_BECAUSE: Final = '`because "…"`'
_COMMENT: Final = "a comment `# …`"
_SOURCE: Final = '`source "…"`'
_TITLE: Final = 'the title in quotes after the name: `QualityReq fast "in time"`'
# Words with which other notations begin a part of a requirement, each with what is nearest to it.
_NOT_IN_BTQ: Final = {
    **dict.fromkeys(("rationale", "reason", "justification", "motivation", "why"), _BECAUSE),
    **dict.fromkeys(("description", "desc", "title", "text", "summary", "statement", "label"), _TITLE),
    **dict.fromkeys(
        ("status", "state", "owner", "author", "stakeholder", "version", "date", "note", "comment", "doc"),
        _COMMENT,
    ),
    **dict.fromkeys(("reference", "ref", "standard", "origin", "url", "link"), _SOURCE),
    **dict.fromkeys(("criticality", "importance", "prio"), "`priority` with a word"),
    **dict.fromkeys(
        ("integrity", "sil", "asil", "dal"), "`priority` with a word, or `source` with the clause that asks for it"
    ),
    **dict.fromkeys(("risk", "risks", "hazards", "prevents", "avoids"), "`mitigates` with the ID of a hazard"),
    **dict.fromkeys(("parent", "parents", "derives", "derived"), "`refines` with the ID of a requirement"),
    **dict.fromkeys(("refined", "decomposed"), "a line `refines` in the other requirement, with the ID of this one"),
    **dict.fromkeys(("approval", "approver", "signed"), "`approved by`, which `btq approve` writes"),
    **dict.fromkeys(("wish", "desire", "target", "ideal", "optional"), "`goal`, a better bound than the required one"),
    **dict.fromkeys(("verification", "verify", "validation"), "`verified by` with a method"),
    **dict.fromkeys(("precondition", "context"), "`while` or `when` with a condition"),
    **dict.fromkeys(("assumption", "assumptions", "assume", "assumes"), "`assuming` with a condition"),
}
