"""The part of the parser that reads claims: what a node must do, and within which bounds.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import COUNTING, VERBS
from btq_lang.diagnostics.model import replace_fix, write_fix
from btq_lang.grammar.claim_mistakes import (
    blank_in_path,
    choice_in_other_words,
    condition_as_event,
    condition_in_other_words,
    event_after_condition,
    every_in_event,
    every_meant,
    is_time,
    is_unit_of_time,
    no_relation,
    no_verb,
    no_within,
    per_unit,
    report_slip,
    signal_last,
    verb_in_other_words,
)
from btq_lang.grammar.claim_words import (
    HAPPENINGS,
    VERB_WORDS,
    at_verb,
    bound_follows,
    followed_ahead,
    is_event_ahead,
    next_head,
)
from btq_lang.grammar.conditions import (
    BOUNDS,
    COMPARISONS,
    NO_RATE,
    RELATIONS,
    accept_one,
    bound_ahead,
    close_group,
    parse_cases,
    parse_cond,
    parse_path,
    parse_simple,
    written_otherwise,
)
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.prose import MODALS
from btq_lang.syntax.tokens import BRACED, NAME, NEWLINE, NODE_CLAUSES, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    AnyEvent,
    Between,
    Bound,
    Bounded,
    Claim,
    Condition,
    EachEvent,
    Event,
    Every,
    Mission,
    NodeRef,
    Pair,
    Path,
    Subject,
    Sum,
    Word,
)
from btq_lang.util.record import replace
from btq_lang.util.text import Span

_NO_MORE: Final = (("no", "more", "than"), ("not", "more", "than"))
_AFTER_VISITS: Final = NODE_CLAUSES | {"QualityReq", "parameters"}


def parse_claim(cursor: Cursor) -> Claim | None:
    """Claim = [ Subject ] Verb | Followed"""
    start = cursor.start()
    if cursor.raw in _EACH and (verb := followed_ahead(cursor)):
        return parse_followed(cursor, verb)
    subject: Subject | None = None
    if not at_verb(cursor):
        subject = parse_subject(cursor)
    if not at_verb(cursor) and not blank_in_path(cursor, subject, VERB_WORDS):
        if subject is not None:
            no_verb(cursor, subject)
        return None
    if isinstance(subject, Path) and subject.names[0].raw in MODALS and len(subject.names) == 1:
        verb_in_other_words(cursor, cursor.index - 1, "")
        subject = None
    return parse_verb(cursor, start, subject)


def parse_verb(cursor: Cursor, start: int, subject: Subject | None) -> Claim:
    """Verb = "takes" Bound | "succeeds" [ "within" Bounded ] | "needs" Cond | …; the verb of a subject"""
    verb = cursor.take()
    bound: Bound | None = None
    condition: Condition | None = None
    resource: Word | None = None
    per: Path | Word | None = None
    event: Event | AnyEvent | None = None
    every = False
    order: Word | None = None
    visits: tuple[NodeRef, ...] = ()
    of: Path | None = None
    counts = verb.raw in COUNTING and bound_follows(cursor, cursor.index)
    form = "per" if counts else ""
    operand = VERBS[verb.raw].operand if not counts else "count"
    if operand == "duration":
        bound = parse_bound(cursor)
    elif operand == "deadline":
        if cursor.accept_word("within"):
            bound = parse_within(cursor)
        elif cursor.kind == QUANTITY:
            no_within(cursor)
    elif operand == "condition":
        if verb.raw == "never" and cursor.raw in HAPPENINGS and cursor.kinds[cursor.index + 1] == NEWLINE:
            cursor.expected("a condition", (_NEVER_FAILS,))
        elif condition_in_other_words(cursor, verb.raw, subject):
            cursor.recover()
        elif not signal_last(cursor, verb.raw):
            if verb.raw == "never":
                condition, bound = parse_forbidden(cursor)
            else:
                condition = parse_cond(cursor)
    elif operand == "use":
        bound = parse_bound(cursor)
        resource = cursor.plain_name("a signal") if cursor.expect_word("of", forgotten=cursor.kind == NAME) else None
    elif operand == "count":
        bound = parse_bound(cursor)
        per = parse_period(cursor, verb.raw, is_optional=not counts)
        of = parse_path(cursor, "a node") if is_time_of(cursor, per) and cursor.accept_word("of") else None
    elif operand == "rate":
        if cursor.accept_word("every"):
            every = True
            bound = parse_within(cursor)
            if cursor.raws[cursor.index - 1].endswith("Hz") and report_slip(cursor):
                bound = None
        else:
            bound = parse_bound(cursor)
            if cursor.kind == NEWLINE:
                cursor.expected("`per` and a time", ("a rate is written `runs at least 10 per 1 s`",))
            else:
                per = cursor.quantity("a duration: 1 s") if cursor.expect_word("per") else None
    elif operand == "event":
        event = parse_event(cursor)
    elif operand == "visits":
        visits, order = nodes_to_visit(cursor)
    elif verb.raw == "ends" and cursor.accept_word("with"):
        condition = None if signal_last(cursor, "ends with") else parse_cond(cursor)
    else:
        bound = parse_within(cursor) if cursor.expect_word("within") else None
        event = parse_event(cursor) if cursor.expect_word("after", ("of", "from", "since")) else None
    end = cursor.last_end()
    return Claim(start, end, subject, verb, bound, condition, resource, per, event, every, visits, order, form, of)


def parse_node_ref(cursor: Cursor) -> NodeRef | None:
    """NodeRef = Path [ "(" Pair { "," Pair } ")" ]"""
    start = cursor.start()
    path = parse_path(cursor, "a node")
    if path is None or cursor.kind != OPEN:
        return NodeRef(start, cursor.last_end(), path) if path is not None else None
    cursor.advance()
    cursor.group += 1
    pairs = cursor.listed(port_value)
    close_group(cursor, "`,` or `)`")
    return NodeRef(start, cursor.last_end(), path, pairs)


def is_time_of(cursor: Cursor, per: Path | Word | None) -> bool:
    """Whether what follows is the node whose time is meant."""
    return isinstance(per, Word) and per.kind == QUANTITY


def parse_period(cursor: Cursor, verb: str, is_optional: bool) -> Path | Word | None:
    """ "per" ( "run" | Path ), of counts;  "per" QUANTITY, of failures"""
    if cursor.accept_word("per"):
        if cursor.kind == QUANTITY and verb == "fails":
            return cursor.take()
        if verb == "fails" and cursor.is_word(cursor.index + 1, "of") and is_unit_of_time(cursor.raw):
            per_unit(cursor)
            return None
        return cursor.take() if cursor.at_word("run") else parse_path(cursor, "`run`, or a node")
    if verb == "fails" and cursor.at("/") and is_unit_of_time(cursor.raws[cursor.index + 1]):
        per_unit(cursor)
    elif not is_optional and report_slip(cursor):
        cursor.recover()
    elif not is_optional:
        note = "the number is that of each run, or of each activation of a node"
        fix = write_fix(" per run", Span(cursor.last_end(), cursor.last_end()).shifted(cursor.base))
        cursor.expected("`per`, and `run` or a node", (note,), (fix,) if cursor.kind == NEWLINE else ())
    return None


def parse_followed(cursor: Cursor, verb: int) -> Claim:
    """Followed = "each" Event "is" "followed" "by" ( Event | Cond ) [ "within" Bounded ]; `verb`: its third word"""
    start = cursor.start()
    if not cursor.accept_word("each"):
        fix = replace_fix(f"Replace `{cursor.raw}` with `each`", cursor.here(), "each", safe=True)
        cursor.complain(cursor.here(), "all occurrences of an event are written `each …`", fix)
        cursor.advance()
    begin = cursor.index
    subject = EachEvent(start, cursor.last_end(), parse_event(cursor))
    subject = replace(subject, end=cursor.last_end())
    if "per" in cursor.raws[cursor.index : verb]:
        cursor.complain(cursor.here(), NO_RATE)
    elif cursor.raws[begin] == "when":
        event_after_condition(cursor, begin)
    begin = min(cursor.index, verb)
    cursor.go_to(verb)
    word = cursor.take()
    cursor.expect_word("by")
    if cursor.raws[begin:verb] != ["is"] and subject.event is not None:
        last = cursor.index - 1
        span = Span(cursor.starts[begin], cursor.starts[last] + len(cursor.raws[last]))
        cursor.complain(span, "this is written `is followed by`", write_fix("is followed by", span))
    event: Event | AnyEvent | None = None
    condition: Condition | None = None
    if cursor.at_word("when") or is_event_ahead(cursor):
        event = parse_event(cursor)
    else:
        begin = cursor.index
        condition = parse_cond(cursor)
        event_after_condition(cursor, begin)
    bound = parse_within(cursor) if cursor.accept_word("within") else None
    return Claim(start, cursor.last_end(), subject, word, bound, condition, event=event)


def parse_subject(cursor: Cursor) -> Subject | None:
    """Subject = Path | "mission" | "every" Name | "from" Event "to" Event | "sum" "of" Path { "," Path }"""
    start = cursor.start()
    if cursor.accept_word("mission"):
        return Mission(start, cursor.last_end())
    if cursor.accept_word("every") or every_meant(cursor):
        name = cursor.name("a node's ID or kind")
        return Every(start, cursor.last_end(), name) if name else None
    if cursor.accept_word("from"):
        first = parse_event(cursor)
        last = parse_event(cursor) if cursor.expect_word("to") else None
        return Between(start, cursor.last_end(), first, last)
    if cursor.accept_word("sum"):
        if not cursor.expect_word("of"):
            return None
        paths = cursor.listed(
            lambda cursor: parse_path(cursor, "a node"), lambda cursor: cursor.accept_and() or cursor.accept(",")
        )
        return Sum(start, cursor.last_end(), paths)
    return parse_path(cursor, "a node")


def parse_event(cursor: Cursor) -> Event | AnyEvent | None:
    """Event = { EventAtom "or" } ( EventAtom | "when" Cond )"""
    first = parse_event_atom(cursor)
    if first is None or not accept_one(cursor, ("or",)):
        return first
    events: list[Event | None] = [first, parse_event_atom(cursor, is_further=True)]
    while events[-1] is not None and accept_one(cursor, ("or",)):
        events.append(parse_event_atom(cursor, is_further=True))
    return AnyEvent(first.start, cursor.last_end(), tuple(events))


def parse_event_atom(cursor: Cursor, is_further: bool = False) -> Event | None:
    """EventAtom = ( Path | "mission" ) ( "starts" | "succeeds" | … );  "when" Cond too; `is_further`: after `or`"""
    start = cursor.start()
    if cursor.accept_word("when"):
        condition = parse_cond(cursor)
        return Event(start, cursor.last_end(), None, "when", condition)
    every_in_event(cursor)
    path = None if cursor.accept_word("mission") else parse_path(cursor, "an event: a node and what happens to it")
    if not (cursor.kind == NAME and cursor.raw in HAPPENINGS) and not blank_in_path(cursor, path, HAPPENINGS):
        note = "an event is a node and what happens to it: `Pick starts`, `Place succeeds`"
        if is_further and condition_as_event(cursor, path, start):
            return None
        if cursor.at_word("or"):
            note = "of several events each has its own word: `Pick fails or Place fails`"
        cursor.expected("starts, succeeds, fails, finishes or halts", (note,), cursor.replaced_by(HAPPENINGS))
        return None
    happening = cursor.take().raw
    return Event(start, cursor.last_end(), path, happening)


def parse_bound(cursor: Cursor) -> Bound | None:
    """ "at" "most" Bounded | "at" "least" Bounded | "less" … | "more" … | "between" Simple "and" Simple"""
    cursor.skip_sign(":")
    start = cursor.start()
    if cursor.accept_word("between"):
        lower = parse_simple(cursor)
        upper = parse_simple(cursor) if cursor.expect_word("and") else None
        return Bound(start, cursor.last_end(), "between", lower, upper)
    relation = parse_relation(cursor)
    if relation is None:
        no_relation(cursor)
        return None
    value = parse_bounded(cursor)
    return Bound(start, cursor.last_end(), relation, value)


def parse_relation(cursor: Cursor) -> str | None:
    """ "at" "most" | "at" "least" | "less" "than" | "more" "than"; other words for it are reported"""
    bound = bound_ahead(cursor) if cursor.kind == NAME or cursor.kind == OPERATOR else None
    if bound is None:
        return None
    length, meant = bound
    if tuple(cursor.raws[cursor.index : cursor.index + length]) != meant:
        written_otherwise(cursor, "this bound", length, " ".join(meant))
    cursor.go_to(cursor.index + length)
    return RELATIONS[meant]


def parse_within(cursor: Cursor) -> Bound:
    """Bounded, as the upper bound after `within` and `every`"""
    start = cursor.start()
    value = parse_bounded(cursor)
    end = cursor.last_end()
    return Bound(min(start, end), end, "<=", value)


def parse_forbidden(cursor: Cursor) -> tuple[Condition | None, Bound | None]:
    """Cond [ "for" "more" "than" Bounded ], after `never`"""
    time = words_for_time(cursor) if "than" in cursor.raws else 0
    if not time:
        condition = parse_cond(cursor)
        return condition, parse_stretch(cursor, after_name=False)
    kept, cursor.raws[time] = cursor.raws[time], "for"  # else a comparison
    condition = parse_cond(cursor)
    cursor.raws[time] = kept
    cursor.go_to(cursor.index)
    after_name = cursor.kinds[time - 1] == NAME and not (time > 1 and cursor.raws[time - 2] in COMPARISONS)
    return condition, parse_stretch(cursor, after_name)


def parse_stretch(cursor: Cursor, after_name: bool) -> Bound | None:
    """ "for" "more" "than" Bounded; other words for it are reported

    Args:
        after_name: of a condition that is a name only, which may be that of a time.
    """
    start = cursor.start()
    has_for = cursor.at_word("for")
    if [cursor.raw, *cursor.raws[cursor.index + 1 : cursor.index + 3]] == ["for", "more", "than"]:
        cursor.go_to(cursor.index + 3)
    elif length := time_in_words(cursor, cursor.index + has_for, is_any=has_for or not after_name):
        stretch_in_other_words(cursor, length + has_for, after_name and not has_for)
        cursor.go_to(cursor.index + length + has_for)
    elif has_for and cursor.kinds[cursor.index + 1] == QUANTITY and is_time(cursor.raws[cursor.index + 1]):
        cursor.advance()
        cursor.complain(cursor.here(), "this time is written `for more than`", cursor.put_before("more than"))
    else:
        return None
    value = parse_bounded(cursor)
    return Bound(start, cursor.last_end(), "<=", value)


def parse_bounded(cursor: Cursor) -> Bounded | None:
    """Bounded = Simple | Simple "if" Cond { "," Simple "if" Cond } "else" Simple"""
    if cursor.at_word("if") or (
        "?" in cursor.raws[cursor.index :] and cursor.raws.index("?", cursor.index) < next_head(cursor)
    ):
        return choice_in_other_words(cursor)
    value = parse_simple(cursor)
    return parse_cases(cursor, value) if value is not None and cursor.at_word("if") else value


def nodes_to_visit(cursor: Cursor) -> tuple[tuple[NodeRef, ...], Word | None]:
    """The nodes after `visits`, and the word `order` if they are to be visited in order."""
    visits = cursor.listed(parse_node_ref, visits_go_on)
    if len(visits) == 1:
        cursor.expected("`,` and another node", ("for one node write `Dock tries at least 1`",))
    if not (cursor.at_word("in") and cursor.is_word(cursor.index + 1, "order")):
        return visits, None
    cursor.advance()
    return visits, cursor.take()


def time_in_words(cursor: Cursor, index: int, is_any: bool = False) -> int:
    """How many words there are at a token that bound a time from above, which follows them; 0 if there are none.

    Args:
        is_any: any bound that is in words; else one that is mostly said of a time.
    """
    for length in (3, 2, 1):
        phrase = tuple(cursor.raws[index : index + length])
        if phrase in BOUNDS and cursor.kinds[index] == NAME and BOUNDS[phrase] != ("less", "than"):
            is_of_time = is_any or "longer" in phrase or phrase in _NO_MORE
            value = index + length
            return length if is_of_time and cursor.kinds[value] == QUANTITY and is_time(cursor.raws[value]) else 0
    return 0


def words_for_time(cursor: Cursor) -> int:
    """The token with which `longer than 30 s` begins, after a condition; 0 if there is none."""
    first = cursor.index + 1
    return next((index for index in range(first, next_head(cursor)) if time_in_words(cursor, index)), 0)


def stretch_in_other_words(cursor: Cursor, length: int, may_be_time: bool) -> None:
    """Report words for `for more than`.

    Args:
        length: how many there are.
        may_be_time: what they follow may be a time, which is then compared.
    """
    first, last = cursor.index, cursor.index + length - 1
    span = Span(cursor.here().start, cursor.starts[last] + len(cursor.raws[last]))
    bound = BOUNDS[tuple(word for word in cursor.raws[first : last + 1] if word != "for")]
    notes: tuple[str, ...] = ()
    fixes = [write_fix("for more than", span, safe=bound != ("at", "most") and not may_be_time)]
    if may_be_time:
        notes = (f"`{cursor.raws[first - 1]} {RELATIONS[bound]} {cursor.raws[last + 1]}` compares a time",)
        fixes.append(write_fix(RELATIONS[bound], span))
    cursor.complain(span, "this time is written `for more than`", *fixes, notes=notes)


def visits_go_on(cursor: Cursor) -> bool:
    """Skip the comma after a node to visit, unless what follows it belongs to the node above: in brackets an attribute,
    after `satisfies` another requirement with its definition.
    """
    if cursor.at(",") and cursor.lists_requirements():
        following = cursor.index + 1
        word, is_named = cursor.raws[following], cursor.kinds[following + 1] in (NAME, STRING)
        if (is_named and word in _AFTER_VISITS) or (cursor.group and cursor.is_operator(following + 1, "=")):
            return False
    return cursor.accept_and() or cursor.accept(",")


def port_value(cursor: Cursor) -> Pair | None:
    """A port, `=`, and its value"""
    key = cursor.name("a port")
    if key is None or not cursor.expect("="):
        return None
    if cursor.kind not in (STRING, NAME, NUMBER, QUANTITY, BRACED):
        cursor.expected("a value")
        return Pair(key, None)
    return Pair(key, cursor.take())


_EACH: Final = frozenset(("each", "every", "all", "any"))
_NEVER_FAILS: Final = (
    "write `succeeds` for a node that must not fail, or `never node Dock` for a node that must not run"
)
