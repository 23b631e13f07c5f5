"""The part of the parser that reads claims: what a node must do, and within which bounds.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.units import dimension_name, parse_unit
from btq_lang.catalog.verbs import COUNTING, VERBS, words
from btq_lang.diagnostics.model import Fix, replace_fix, write_fix
from btq_lang.grammar.clause_slips import clause_slip
from btq_lang.grammar.conditions import (
    BOUNDS,
    COMPARISONS,
    HEADS,
    METADATA_HEADS,
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
from btq_lang.grammar.cursor import Cursor, shown
from btq_lang.grammar.prose import MODALS, clause_meant, state_meant
from btq_lang.syntax.scan import number_end
from btq_lang.syntax.tokens import BRACED, CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Amount,
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
    quote,
)
from btq_lang.util.record import replace
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

_BEFORE_BOUNDS: Final = frozenset(("fails", "finishes"))  # verbs there alone: elsewhere events, or names
# Those that follow a subject; `followed` is one only after `each … is`.
VERB_WORDS: Final = (
    frozenset(verb.partition(" ")[0] for verb in VERBS.keys() - words(operands=("answer",))) - _BEFORE_BOUNDS
)
HAPPENINGS: Final = frozenset(("starts", "succeeds", "fails", "finishes", "halts"))


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
        elif cursor.at_word("to") and verb_in_other_words(cursor, cursor.index - 1, before_verb(cursor, subject)):
            cursor.recover()
        elif not signal_last(cursor, verb.raw):
            condition = parse_cond(cursor)
            bound = parse_stretch(cursor) if verb.raw == "never" and cursor.raw == "for" else None
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
        return cursor.take() if cursor.at_word("run") else parse_path(cursor, "`run`, or a node")
    if not is_optional and report_slip(cursor):
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
    subject = EachEvent(start, cursor.last_end(), parse_event(cursor))
    subject = replace(subject, end=cursor.last_end())
    begin = cursor.index
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
        condition = parse_cond(cursor)
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
    events: list[Event | None] = [first, parse_event_atom(cursor)]
    while events[-1] is not None and accept_one(cursor, ("or",)):
        events.append(parse_event_atom(cursor))
    return AnyEvent(first.start, cursor.last_end(), tuple(events))


def parse_event_atom(cursor: Cursor) -> Event | None:
    """EventAtom = ( Path | "mission" ) ( "starts" | "succeeds" | … );  "when" Cond too"""
    start = cursor.start()
    if cursor.accept_word("when"):
        condition = parse_cond(cursor)
        return Event(start, cursor.last_end(), None, "when", condition)
    path = None if cursor.accept_word("mission") else parse_path(cursor, "an event: a node and what happens to it")
    if not (cursor.kind == NAME and cursor.raw in HAPPENINGS) and not blank_in_path(cursor, path, HAPPENINGS):
        note = "an event is a node and what happens to it: `Pick starts`, `Place succeeds`"
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


def parse_stretch(cursor: Cursor) -> Bound | None:
    """ "for" "more" "than" Bounded; other words for `more than` are reported"""
    start = cursor.start()
    relation = BOUNDS.get(tuple(cursor.raws[cursor.index + 1 : cursor.index + 3]))
    if relation not in (("more", "than"), ("at", "least")):
        return None
    cursor.advance()
    if not cursor.at_word("more"):
        written_otherwise(cursor, "this time", 2, "more than")
    cursor.go_to(cursor.index + 2)
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


# ---- what productions ask and report ----


def at_verb(cursor: Cursor) -> bool:
    """Whether the current word is a verb, as `fails` is before a bound alone."""
    if cursor.kind != NAME:
        return False
    if cursor.raw == "visits":  # one only where nodes follow
        return cursor.kinds[cursor.index + 1] in (NAME, STRING) and not is_verb_ahead(cursor, 1)
    return cursor.raw in VERB_WORDS or (cursor.raw in _BEFORE_BOUNDS and bound_follows(cursor, cursor.index + 1))


def nodes_to_visit(cursor: Cursor) -> tuple[tuple[NodeRef, ...], Word | None]:
    """The nodes after `visits`, and the word `order` if they are to be visited in order."""
    visits = cursor.listed(parse_node_ref, lambda cursor: cursor.accept_and() or cursor.accept(","))
    if len(visits) == 1:
        cursor.expected("`,` and another node", ("for one node write `Dock tries at least 1`",))
    if not (cursor.at_word("in") and cursor.is_word(cursor.index + 1, "order")):
        return visits, None
    cursor.advance()
    return visits, cursor.take()


def port_value(cursor: Cursor) -> Pair | None:
    """A port, `=`, and its value"""
    key = cursor.name("a port")
    if key is None or not cursor.expect("="):
        return None
    if cursor.kind not in (STRING, NAME, NUMBER, QUANTITY, BRACED):
        cursor.expected("a value")
        return Pair(key, None)
    return Pair(key, cursor.take())


def bound_follows(cursor: Cursor, index: int) -> bool:
    """Whether a bound begins at a token; `within` begins none of a count."""
    first = cursor.raws[index]
    if first == "between" or (first, *cursor.raws[index + 1 : index + 2]) in RELATIONS:
        return True
    if first == "within" or (first == "over" and cursor.is_word(index + 1, "last")):
        return False
    return any(tuple(cursor.raws[index : index + length]) in BOUNDS for length in (1, 2, 3, 4, 5))


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
    message = " or ".join(f"`{shown(clause)}`" for clause in clauses)
    cursor.complain(span, f"this clause is written {message}", *fixes, notes=(note,) if note else ())


def every_meant(cursor: Cursor) -> bool:
    """Report `all MoveBase`, and read it as `every`."""
    if cursor.kind != NAME or cursor.raw not in ("all", "each", "any"):
        return False
    if cursor.kinds[cursor.index + 1] != NAME or cursor.raws[cursor.index + 1] in VERB_WORDS:
        return False
    fix = replace_fix(f"Replace `{cursor.raw}` with `every`", cursor.here(), "every", safe=True)
    cursor.complain(cursor.here(), "all nodes of a kind are written `every …`", fix)
    cursor.advance()
    return True


def followed_ahead(cursor: Cursor) -> int:
    """The token `followed` of a clause that begins here; 0 if none does."""
    raws = cursor.raws
    for index in range(cursor.index + 2, len(raws) - 1):
        if raws[index] == "QualityReq" and raws[index - 1] == ",":
            return 0
        if raws[index] == "followed" and (raws[index - 1] == "is" or raws[index + 1] == "by"):
            return index
    return 0


def is_event_ahead(cursor: Cursor) -> bool:
    """Whether a path and what happens to it are next, rather than a condition and the verb of another clause."""
    last, kinds, raws = cursor.index, cursor.kinds, cursor.raws
    if kinds[last] not in (NAME, STRING):
        return False
    while raws[last + 1] == "/" and kinds[last + 2] in (NAME, STRING):
        last += 2
    last += 1
    if kinds[last] != NAME or raws[last] not in HAPPENINGS:
        return False
    if raws[last + 1] == "within":
        later = next((raw for raw in raws[last + 2 :] if raw == "after" or raw in VERB_WORDS or raw in HEADS), "")
        return later != "after"  # `starts within 2 s after …`
    return raws[last + 1] != "between" and tuple(raws[last + 1 : last + 3]) not in RELATIONS


def is_verb_ahead(cursor: Cursor, further: int) -> bool:
    """Whether the word `further` tokens ahead is a verb."""
    index = cursor.index + further
    return index < len(cursor.kinds) and cursor.kinds[index] == NAME and cursor.raws[index] in VERB_WORDS


def no_verb(cursor: Cursor, subject: Subject) -> None:
    """Report a subject without a verb, or of a misspelt verb that was read as a subject."""
    first = subject.names[0] if isinstance(subject, Path) and len(subject.names) == 1 else None
    if in_other_words(cursor, subject) or situation(cursor, first):
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
    elif first is not None and first.raw == "at" and report_slip(cursor):
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


def written_as(cursor: Cursor, begin: int, end: int, subject: str, words: str) -> None:
    """Report that the words between two tokens, after a subject, are others here."""
    span = Span(cursor.starts[begin], cursor.starts[end - 1] + len(cursor.raws[end - 1]))
    tail = cursor.text[span.end : cursor.starts[-1]].strip()
    whole = " ".join(part for part in (subject, words, tail) if part)
    cursor.complain(span, f"this clause is written `{shown(whole)}`", write_fix(words, span))


def next_head(cursor: Cursor) -> int:
    """The next token that begins another clause, or ends the line or the brackets."""
    end = cursor.index
    depth = 0
    while cursor.kinds[end] != NEWLINE and not (cursor.kinds[end] == NAME and cursor.raws[end] in HEADS):
        depth += (cursor.kinds[end] == OPEN) - (cursor.kinds[end] == CLOSE)
        if depth < 0:
            break
        end += 1
    return end


def situation(cursor: Cursor, first: Word | None) -> bool:
    """Report `unless humans_near`, with the condition that is written there."""
    if first is None or first.kind != NAME or first.raw not in ("unless", "if") or cursor.kind == NEWLINE:
        return False
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
    note = f"a name of several words goes in quotes: {quote(cursor.text[start:end])}"
    cursor.complain(Span(start, end), message, write_fix(written, Span(start, end)), notes=(note,))
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


def is_time(raw: str) -> bool:
    """Whether a quantity is a time: `30 s`."""
    unit = parse_unit(raw[number_end(raw, 0) :].strip())
    return unit is not None and dimension_name(unit) == "time"


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
    "before": "write `from Pick starts to Place succeeds takes at most 45 s`, or `Place follows Pick succeeds`",
    "between": "a range is written `keeps 0 N <= force <= 3 N`",
    "always": "write `keeps battery >= 15 %`",
    "not": "write `never lamp_on`, or `keeps not lamp_on`",
    "quality": QUALITY_IN_HEAD,
    "severity": "a hazard has a `severity`, a requirement a `priority`",
    **dict.fromkeys(
        ("title", "description", "text"), 'a requirement has one title, after its name: `QualityReq fast "in time"`'
    ),
}
_NO_NAMES: Final = HEADS.union(
    ("and", "or", "not", "if", "else", "is", "to", "until", "of", "by", "per", "at", "within", "after")
)
_BEGINNINGS: Final = VERB_WORDS | HEADS | METADATA_HEADS
_EACH: Final = frozenset(("each", "every", "all", "any"))
_OPEN: Final = re.compile("<[a-z]+>")  # what is left to choose in a clause
_A_CHOICE: Final = "60 s if battery_low else 30 s"
_A_VERB: Final = "a verb: takes, succeeds, needs, keeps, …"
_NEVER_FAILS: Final = (
    "write `succeeds` for a node that must not fail, or `never node Dock` for a node that must not run"
)
_OF_DURATIONS: Final = words(operands=("duration",))
