"""The part of the parser that reads scenarios: what nodes do, what changes, and what is expected then.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.attributes import parse_value
from btq_lang.grammar.claim_mistakes import every_meant
from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS, bound_follows
from btq_lang.grammar.claims import parse_claim, port_value
from btq_lang.grammar.conditions import close_group, parse_cond, parse_path
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.metadata import list_goes_on, parse_requirement_id, parse_text
from btq_lang.grammar.nodes import no_block
from btq_lang.grammar.scenario_slips import (
    activations_counted,
    bound_of_duration,
    misplaced_head,
    no_behavior,
    no_expectation,
    no_trigger,
    step_meant,
    verdict_meant,
)
from btq_lang.grammar.scenario_words import ANSWERS, DURATIONS, ORDINALS, OUTCOMES, RESULTS, STEPS, TIMES, VERDICTS
from btq_lang.syntax.scan import number_end
from btq_lang.syntax.scenarios import (
    Aspect,
    Assignment,
    Behavior,
    Elapsed,
    EventTrigger,
    Expect,
    ExpectedOutcome,
    ExpectedRuns,
    ExpectedVerdict,
    Finally,
    Given,
    HaltMission,
    NeverEnds,
    NodePattern,
    NodesDo,
    Scenario,
    Step,
    When,
)
from btq_lang.syntax.tokens import BRACED, CLOSE, NAME, NEWLINE, NUMBER, OPEN, QUANTITY, STRING
from btq_lang.syntax.tree import Claim, Condition, Event, Pair, Word
from btq_lang.util.spelling import near
from btq_lang.util.text import Span


def parse_scenario(cursor: Cursor, level: int) -> Scenario:
    """ "scenario" STRING [ "of" Name ] [ "verifies" Name { "," Name } ] NL [ INDENT { Step NL } DEDENT ]"""
    start = cursor.take().start
    title = scenario_title(cursor)
    tree = cursor.name("a tree") if cursor.accept_word("of") else None
    verifies: tuple[Word, ...] = ()
    if cursor.accept_word("verifies"):
        verifies = cursor.listed(lambda cursor: parse_requirement_id(cursor, "the ID of a requirement"), ids_go_on)
    end = cursor.end_line(misplaced_head(cursor))
    steps: list[Step] = []
    cursor.in_scenario = True
    while cursor.deeper(level):
        inner = cursor.lexer.level
        cursor.scan()
        step = parse_step(cursor)
        if step is not None:
            steps.append(step)
        end = cursor.end_line()
        no_block(cursor, inner)
    cursor.in_scenario = False
    return Scenario(start, end, title, tree, verifies, tuple(steps))


def parse_step(cursor: Cursor) -> Step | None:
    """Step = Given | When | Expect"""
    word = cursor.raw if cursor.kind == NAME and cursor.raw in STEPS else step_meant(cursor)
    if word == "given":
        return parse_given(cursor)
    if word == "when":
        return parse_when(cursor)
    return parse_expect(cursor) if word == "expect" else None


def parse_given(cursor: Cursor) -> Given:
    """ "given" ( NodesDo | Assignment )"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    fact = parse_assignment(cursor) if at_assignment(cursor) else parse_nodes_do(cursor)
    return Given(start, cursor.last_end(), fact)


def parse_when(cursor: Cursor) -> When:
    """ "when" Trigger ":" Effect"""
    start = cursor.take().start
    trigger = parse_trigger(cursor)
    effect: NodesDo | Assignment | HaltMission | None = None
    if trigger is None:
        cursor.recover()
    elif cursor.accept(":") or no_colon(cursor):
        effect = parse_effect(cursor)
    return When(start, cursor.last_end(), trigger, effect)


def parse_expect(cursor: Cursor) -> Expect:
    """ "expect" ( Claim | Runs | Finally | "mission" ( "does" "not" "end" | "fails" | "halts" ) | Verdict )"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    expectation: Claim | ExpectedRuns | Finally | NeverEnds | ExpectedOutcome | ExpectedVerdict | None
    if cursor.kind == NEWLINE:
        expectation = None
        no_expectation(cursor)
    elif is_outcome(cursor):
        mission, word = cursor.take(), cursor.take()
        expectation = ExpectedOutcome(mission.start, word.end, word)
    elif is_verdict(cursor) or verdict_meant(cursor):
        expectation = parse_verdict(cursor)
    elif cursor.kind == BRACED or (cursor.at_word("finally") and cursor.raws[cursor.index + 1] not in VERB_WORDS):
        expectation = parse_finally(cursor)
    elif cursor.at_word("mission") and cursor.is_word(cursor.index + 1, "does"):
        expectation = never_ends(cursor)
    elif is_runs(cursor):
        expectation = parse_runs(cursor)
    else:
        expectation = expected_claim(cursor)
    return Expect(start, cursor.last_end(), expectation)


def parse_nodes_do(cursor: Cursor) -> NodesDo | None:
    """Nodes Behavior { "," [ "then" ] Behavior }"""
    start = cursor.start()
    nodes = parse_nodes(cursor)
    if nodes is None:
        return None
    behaviors: list[Behavior] = []
    if cursor.at_word("then"):
        fix = replace_fix("Remove `then`", Span(cursor.here().start, cursor.starts[cursor.index + 1]), "", safe=True)
        cursor.complain(cursor.here(), "the first behavior has no `then`", fix)
        cursor.advance()
    behavior = parse_behavior(cursor)
    while behavior is not None:
        behaviors.append(behavior)
        behavior = parse_behavior(cursor) if behaviors_go_on(cursor) else None
    if cursor.kind != NEWLINE:
        no_behavior(cursor)
    return NodesDo(start, cursor.last_end(), nodes, tuple(behaviors))


def parse_nodes(cursor: Cursor) -> NodePattern | None:
    """Nodes = ( "every" Name | Path ) [ "(" Pair { "," Pair } ")" ]"""
    start = cursor.start()
    nodes = selected(cursor)
    if nodes is None or cursor.kind != OPEN:
        return nodes
    cursor.advance()
    cursor.group += 1
    pairs = cursor.listed(port_value)
    close_group(cursor, "`,` or `)`")
    return NodePattern(start, cursor.last_end(), nodes.every, nodes.path, pairs)


def parse_behavior(cursor: Cursor) -> Behavior | None:
    """Behavior = ( Result [ Duration ] | Duration [ Result ] ) [ Times ] [ "and" "writes" Pair { "," Pair } ]"""
    start = cursor.start()
    result: Aspect | None = None
    duration: Aspect | None = None
    aspects: list[Aspect] = []
    while cursor.kind == NAME and (cursor.raw in RESULTS or cursor.raw in DURATIONS):
        word = cursor.here()
        if cursor.raw in RESULTS:
            if result is not None:
                fix = cursor.put_before(", then") if duration is None else None
                message = f"a behavior has one result: `{result.word.raw}` or `{cursor.raw}`"
                note = "what the node does in its next activation goes after `, then`"
                cursor.complain(word, message, *((fix,) if fix else ()), notes=(note,))
            result = parse_result(cursor)
            aspects.append(result)
        else:
            if duration is not None:
                message = f"a behavior has one duration: `{duration.word.raw}` or `{cursor.raw}`"
                cursor.complain(word, message)
            duration = parse_duration(cursor)
            aspects.append(duration)
    if not aspects:
        no_behavior(cursor)
        return None
    times = parse_times(cursor)
    writes: tuple[Pair, ...] = ()
    if cursor.at_word("and") and cursor.is_word(cursor.index + 1, "writes"):
        cursor.advance()
        cursor.advance()
        writes = cursor.listed(written_entry, writes_go_on)
    return Behavior(start, cursor.last_end(), tuple(aspects), times, writes)


def parse_result(cursor: Cursor) -> Aspect:
    """Result = "succeeds" | "fails" | "skips" | "does" "not" "end" | "answers" Answer { "," Answer }"""
    word = cursor.take()
    answers: tuple[Word, ...] = ()
    if word.raw == "does" and cursor.expect_word("not"):
        cursor.expect_word("end")
    elif word.raw == "answers":
        answers = cursor.listed(parse_answer, answers_go_on)
    return Aspect(word.start, cursor.last_end(), word, None, answers)


def parse_answer(cursor: Cursor) -> Word | None:
    """ "true" | "false" """
    if cursor.kind == NAME and cursor.raw in ANSWERS:
        return cursor.take()
    meant = _ANSWERS_MEANT.get(cursor.raw.lower(), "")
    if not meant:
        cursor.expected("true or false", ("the answers of a condition are separated by commas: `false, true`",))
        return None
    cursor.complain(cursor.here(), f"an answer is true or false, not `{cursor.raw}`", write_fix(meant, cursor.here()))
    return cursor.take()


def parse_duration(cursor: Cursor) -> Aspect:
    """Duration = ( "takes" | "after" ) QUANTITY"""
    word = cursor.take()
    bound_of_duration(cursor)
    quantity = cursor.quantity("a duration: 3 s")
    return Aspect(word.start, cursor.last_end(), word, quantity)


def parse_times(cursor: Cursor) -> Word | None:
    """Times = "once" | "twice" | NUMBER "times" """
    if cursor.kind == NAME and cursor.raw in TIMES:
        return cursor.take()
    if cursor.kind == QUANTITY and cursor.raw.endswith("times"):  # a unit
        return counted(cursor)
    if cursor.kind != NUMBER:
        return None
    number = counted(cursor)
    cursor.expect_word("times", ("time", "x"))
    return number


def parse_assignment(cursor: Cursor) -> Assignment:
    """Assignment = ( NAME | BRACED ) "=" Value"""
    start = cursor.start()
    if cursor.kind == STRING:
        fix = write_fix(f"{{{cursor.raw[1:-1]}}}", cursor.here())
        cursor.complain(cursor.here(), "a signal has no quotes, and an entry is in braces: `{key} = …`", fix)
    target = cursor.take()
    if not cursor.accept("="):
        sign = cursor.here()
        if cursor.raw in _ASSIGNED:
            last = cursor.index + (cursor.raws[cursor.index + 1] == "=" and cursor.raw == ":")
            sign = Span(sign.start, cursor.starts[last] + len(cursor.raws[last]))
            may_answer = cursor.raw == "is" and cursor.raws[last + 1] in ANSWERS
            fixes = (write_fix("answers", sign),) if may_answer else ()
            cursor.complain(sign, "a value goes after `=`", write_fix("=", sign, safe=not may_answer), *fixes)
            cursor.go_to(last + 1)
        else:
            cursor.expected("`=` and a value")
            return Assignment(start, cursor.last_end(), target, None)
    value = parse_value(cursor)
    return Assignment(start, cursor.last_end(), target, value)


def parse_trigger(cursor: Cursor) -> Elapsed | EventTrigger | Condition | None:
    """Trigger = QUANTITY "have" "passed" | Happening [ "for" "the" Ordinal "time" ] | Cond"""
    if cursor.kind == QUANTITY and cursor.raws[cursor.index + 1] in _PASSED:
        return elapsed(cursor)
    if not is_happening(cursor):
        return None if no_trigger(cursor) else parse_cond(cursor)
    start = cursor.start()
    event, pairs = parse_happening(cursor)
    number: Word | None = None
    if cursor.accept_word("for"):
        cursor.expect_word("the", forgotten=True)
        number = parse_ordinal(cursor)
        if number is not None:
            cursor.expect_word("time", ("times",))
    return EventTrigger(start, cursor.last_end(), event, pairs, number)


def parse_happening(cursor: Cursor) -> tuple[Event, tuple[Pair, ...]]:
    """Happening = ( NodeRef | "mission" ) ( "starts" | "succeeds" | "fails" | "finishes" | "halts" )"""
    start = cursor.start()
    path = None if cursor.accept_word("mission") else parse_path(cursor, "a node")
    pairs: tuple[Pair, ...] = ()
    if cursor.kind == OPEN:
        cursor.advance()
        cursor.group += 1
        pairs = cursor.listed(port_value)
        close_group(cursor, "`,` or `)`")
    happening = cursor.take().raw
    return Event(start, cursor.last_end(), path, happening), pairs


def parse_ordinal(cursor: Cursor) -> Word | None:
    """Ordinal = NUMBER | "first" | "second" | "third" """
    if cursor.kind == NUMBER:
        return counted(cursor)
    if cursor.kind == NAME and cursor.raw in ORDINALS:
        return cursor.take()
    return cursor.missing_word("a number: `for the 2 time`, or first, second or third")


def parse_effect(cursor: Cursor) -> NodesDo | Assignment | HaltMission | None:
    """Effect = NodesDo | Assignment | "mission" "halts" """
    if at_assignment(cursor):
        return parse_assignment(cursor)
    if not cursor.at_word("mission"):
        return parse_nodes_do(cursor)
    start = cursor.take().start
    cursor.expect_word("halts", ("stops", "ends", "aborts", "halted"))
    return HaltMission(start, cursor.last_end())


def parse_runs(cursor: Cursor) -> ExpectedRuns | None:
    """Runs = ( "every" Name | Path ) [ "(" { Pair "," } ( Pair | NAME ) ")" ] "runs" Datum { "," Datum }"""
    start = cursor.start()
    nodes = selected(cursor)
    if nodes is None:
        return None
    port: Word | None = None
    pairs: list[Pair] = []
    if cursor.kind == OPEN:
        cursor.advance()
        cursor.group += 1
        while port is None and cursor.kind in (NAME, STRING):
            if cursor.kinds[cursor.index + 1] == CLOSE:
                port = cursor.take()
            elif (pair := port_value(cursor)) is not None:
                pairs.append(pair)
                cursor.accept(",")
        close_group(cursor, "`)`")
        nodes = NodePattern(start, cursor.last_end(), nodes.every, nodes.path, tuple(pairs))
    cursor.advance()  # `runs`
    values = cursor.listed(parse_datum, data_go_on)
    return ExpectedRuns(start, cursor.last_end(), nodes, port, values)


def parse_datum(cursor: Cursor) -> Word | None:
    """Datum = STRING | NUMBER | QUANTITY | BRACED"""
    if cursor.kind == NAME:
        cursor.complain(cursor.here(), "a value of a port goes in quotes", cursor.put_in_quotes())
        return cursor.take()
    return cursor.take() if cursor.kind in _DATA else cursor.missing_word('a value of a port: "A", 2 or {key}')


def parse_finally(cursor: Cursor) -> Finally:
    """Finally = "finally" Cond"""
    start = cursor.start()
    if not cursor.accept_word("finally"):
        cursor.complain(
            cursor.here(), "a condition at the end of the run goes after `finally`", cursor.put_before("finally")
        )
    condition = parse_cond(cursor)
    return Finally(start, cursor.last_end(), condition)


def parse_verdict(cursor: Cursor) -> ExpectedVerdict:
    """Verdict = Name [ "satisfied" | "violated" | "unknown" | "undecided" | "never" "exercised" | … ]"""
    name = cursor.take()
    words: list[Word] = []
    while cursor.kind == NAME:
        words.append(cursor.take())
    return ExpectedVerdict(name.start, cursor.last_end(), name, tuple(words))


# ---- what productions ask and report ----


def scenario_title(cursor: Cursor) -> Word | None:
    """The title after `scenario`; without one what follows it is read."""
    cursor.skip_sign(":", "=")
    if cursor.kind != NEWLINE and not (cursor.raw in ("of", "verifies") and cursor.kind == NAME):
        return parse_text(cursor, "the scenario's title", " of ")
    cursor.complain(cursor.here(), f"expected the scenario's title in quotes, found {cursor.found()}")
    return None


def at_assignment(cursor: Cursor) -> bool:
    """Whether a signal or an entry gets a value here, perhaps with another sign than `=`."""
    if cursor.kind == BRACED:
        return True
    if cursor.kind != NAME and cursor.kind != STRING:
        return False
    following = cursor.raws[cursor.index + 1]
    return following in _ASSIGNED and cursor.raw != "every"


def selected(cursor: Cursor) -> NodePattern | None:
    """( "every" Name | Path ), without ports"""
    start = cursor.start()
    if is_every(cursor) and (cursor.accept_word("every") or every_meant(cursor)):
        every = cursor.take()
        return NodePattern(start, cursor.last_end(), every, None)
    if cursor.at_word("mission"):
        cursor.complain(cursor.here(), "a given is about a node: the mission does what its nodes do")
    path = parse_path(cursor, "a node, a signal or {key}")
    return NodePattern(start, cursor.last_end(), None, path) if path is not None else None


def counted(cursor: Cursor) -> Word:
    """A number, with or without the unit `times`, which is to be a whole one from 1."""
    start, raw = cursor.start(), cursor.raw[: number_end(cursor.raw, 0)]
    if not raw.isdecimal() or not int(raw):
        cursor.complain(cursor.here(), f"expected a whole number from 1, found `{raw}`")
    cursor.advance()
    return Word(NUMBER, start, raw)


def is_every(cursor: Cursor) -> bool:
    """Whether a name follows `every`, or a word that may be meant as it; else the word is a name."""
    following = cursor.index + 1
    if cursor.kind != NAME or cursor.kinds[following] not in (NAME, STRING):
        return False
    return cursor.raws[following] not in RESULTS and cursor.raws[following] not in DURATIONS


def after_nodes(cursor: Cursor) -> int:
    """The token after a node, `every` and a name, or `mission`, with its brackets; 0 if none of them is next."""
    kinds, raws = cursor.kinds, cursor.raws
    last = cursor.index + (cursor.at_word("every") and kinds[cursor.index + 1] in (NAME, STRING))
    if kinds[last] not in (NAME, STRING):
        return 0
    while raws[last + 1] == "/" and kinds[last + 2] in (NAME, STRING):
        last += 2
    last += 1
    if kinds[last] == OPEN and CLOSE in kinds[last:]:
        last = kinds.index(CLOSE, last) + 1
    return last


def is_happening(cursor: Cursor) -> bool:
    """Whether a node or the mission is next, and what happens to it."""
    index = after_nodes(cursor)
    return index > 0 and cursor.kinds[index] == NAME and cursor.raws[index] in HAPPENINGS


def is_runs(cursor: Cursor) -> bool:
    """Whether nodes and the values of their port are next, and no claim of how often they run."""
    index = after_nodes(cursor)
    if not index or not cursor.is_word(index, "runs"):
        return False
    kind = cursor.kinds[index + 1]
    if kind != NAME:
        return kind in _DATA or cursor.kinds[index - 1] == CLOSE
    following = cursor.raws[index + 1]
    return not (following == "every" or following in TIMES or bound_follows(cursor, index + 1))


def is_outcome(cursor: Cursor) -> bool:
    """Whether only `mission` and how it ends are left of the line."""
    return cursor.at_word("mission") and tuple(cursor.raws[cursor.index + 1 : -1]) in OUTCOMES


def is_verdict(cursor: Cursor) -> bool:
    """Whether a requirement and its verdict are all that is left of the line; a quoted name before `never exercised`
    is a node.
    """
    if cursor.kind not in (NAME, STRING):
        return False
    words = tuple(cursor.raws[cursor.index + 1 : -1])
    if not words:
        return cursor.kind == STRING or not (cursor.raw in VERB_WORDS or cursor.raw in _NO_REQUIREMENT)
    return words in VERDICTS and not (cursor.kind == STRING and words[0] == "never")


def expected_claim(cursor: Cursor) -> Claim | None:
    """A claim, whose subject is the mission if it has none."""
    index = after_nodes(cursor)
    if index and activations_counted(cursor, index):
        return None
    cursor.clause_starts = -1, cursor.starts[cursor.index]
    claim = parse_claim(cursor)
    if claim is not None and cursor.kind != NEWLINE:
        cursor.expected("the end of the line", (_ONE_CLAIM,))
    return claim


def never_ends(cursor: Cursor) -> NeverEnds:
    """ "mission" "does" "not" "end" """
    start = cursor.take().start
    cursor.advance()
    if cursor.expect_word("not"):
        cursor.expect_word("end", ("finish", "stop"))
    return NeverEnds(start, cursor.last_end())


def elapsed(cursor: Cursor) -> Elapsed:
    """QUANTITY "have" "passed" """
    duration = cursor.take()
    begin = cursor.index
    while cursor.kind == NAME and cursor.raw in _PASSED:
        cursor.advance()
    if cursor.raws[begin : cursor.index] != ["have", "passed"]:
        span = Span(duration.start + cursor.base, cursor.last_end() + cursor.base)
        written = f"{duration.raw} have passed"
        cursor.complain(span, f"a time is written `{written}`", write_fix(written, span))
    return Elapsed(duration.start, cursor.last_end(), duration)


def no_colon(cursor: Cursor) -> bool:
    """Report that the `:` before an effect is missing; whether the effect can be read."""
    if cursor.at(",") or cursor.at_word("then"):
        last = cursor.index
        if cursor.at(",") and cursor.is_word(last + 1, "then"):
            last += 1
        span = Span(cursor.last_end() + cursor.base, cursor.starts[last] + len(cursor.raws[last]))
        cursor.complain(cursor.here(), "what happens then goes after `:`", replace_fix("Write `:`", span, ":"))
        cursor.go_to(last + 1)
        return True
    if cursor.kind == NAME and (happening := near(cursor.raw, HAPPENINGS, limit=1)):
        cursor.misspelt(cursor.here(), cursor.raw, happening[0])
        cursor.recover()
        return False
    end = cursor.last_end() + cursor.base
    fix = replace_fix("Put `:` before it", Span(end, end), ":")
    notes = ("what happens then goes after `:`",)
    cursor.expected("`:` and what happens then", notes, (fix,) if cursor.kind in (NAME, STRING, BRACED) else ())
    return False


def behaviors_go_on(cursor: Cursor) -> bool:
    """Skip what separates two behaviors: `,` or `, then`; report others."""
    if cursor.accept(","):
        cursor.accept_word("then")
        return True
    index = cursor.index + cursor.at_word("and")
    if not cursor.is_word(index, "then"):
        return False
    change = FixEdit(Place(Span(cursor.last_end() + cursor.base, cursor.starts[index])), ", ")
    cursor.complain(cursor.here(), "behaviors are separated by `, then`", Fix("Write `, then`", (change,), safe=True))
    cursor.go_to(index + 1)
    return True


def answers_go_on(cursor: Cursor) -> bool:
    """Skip the comma before another answer; report that it is missing."""
    following = cursor.raws[cursor.index + 1] if cursor.at(",") else ""
    if following in ANSWERS or following.lower() in _ANSWERS_MEANT:
        return cursor.accept(",")
    return cursor.kind == NAME and cursor.raw in ANSWERS and no_comma(cursor)


def data_go_on(cursor: Cursor) -> bool:
    """Skip the comma before another value; report that it is missing."""
    return cursor.accept(",") or cursor.accept_and() or (cursor.kind in _DATA and no_comma(cursor))


def ids_go_on(cursor: Cursor) -> bool:
    """Skip the comma before another ID; report that it is missing."""
    is_id = cursor.at_name() and cursor.raw not in ("of", "and")
    return list_goes_on(cursor) or (is_id and no_comma(cursor))


def writes_go_on(cursor: Cursor) -> bool:
    """Skip the comma before another entry; another behavior may follow it instead."""
    following = cursor.index + 1
    is_entry = cursor.at(",") and cursor.kinds[following] in (NAME, STRING, BRACED)
    return is_entry and cursor.is_operator(following + 1, "=") and cursor.accept(",")


def no_comma(cursor: Cursor) -> bool:
    """Report that the comma before the current word is missing."""
    end = cursor.last_end() + cursor.base
    fix = replace_fix("Put `,` before it", Span(end, end), ",", safe=True)
    cursor.complain(cursor.here(), f"expected `,` before {cursor.found()}", fix)
    return True


def written_entry(cursor: Cursor) -> Pair | None:
    """Pair, whose key is an entry"""
    if cursor.kind == BRACED:
        key = cursor.here()
        cursor.complain(key, "the entries that a node writes have no braces", write_fix(cursor.raw[1:-1], key))
        word = cursor.take()
    else:
        named = cursor.name("an entry")
        if named is None:
            return None
        word = named
    return Pair(word, parse_value(cursor) if cursor.expect("=") else None)


_DATA: Final = frozenset((STRING, NUMBER, QUANTITY, BRACED))
_ASSIGNED: Final = ("=", "==", ":", "is")  # the first is right
_PASSED: Final = ("have", "passed", "has", "elapsed", "later", ":")  # the first two are right
_NO_REQUIREMENT: Final = ("mission", "every", "finally", "not", "each", "from", "sum")
_ANSWERS_MEANT: Final = {
    **dict.fromkeys(("yes", "success", "on", "1", "true"), "true"),
    **dict.fromkeys(("no", "failure", "off", "0", "false"), "false"),
}
_ONE_CLAIM: Final = (
    "a step expects one claim; write another `expect`, or a requirement with several clauses and expect its verdict"
)
