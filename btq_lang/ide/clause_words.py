"""What may follow in the clauses of a requirement: the grammar of docs/grammar.md, read backwards from the cursor."""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.catalog.verbs import COUNTING, VERBS
from btq_lang.catalog.verbs import words as words_of
from btq_lang.grammar.claim_words import HAPPENINGS
from btq_lang.grammar.clauses import ACTIONS, AVERAGE, EXPERIMENTS, METHODS, TIME
from btq_lang.grammar.conditions import COMPARISONS, FUNCTIONS, METADATA_HEADS
from btq_lang.syntax.tokens import BRACED, CLOSE, NAME, NUMBER, OPEN, QUANTITY, STRING, Token
from btq_lang.util.record import Record, replace


class Expected(Record):
    """What may follow at a place.

    Attributes:
        words: words and phrases of the grammar.
        condition: the beginning of a condition: contexts, signals, `not` …
        operand: an operand of a comparison or sum: parameters, signals, `max()` …
        value: the value of a bound: parameters and signals.
        signal: the name of a signal.
        node: a path to a node.
        requirement, hazard: the ID of one.
        clause: another clause.
    """

    words: tuple[str, ...] = ()
    condition: bool = False
    operand: bool = False
    value: bool = False
    signal: bool = False
    node: bool = False
    clause: bool = False
    requirement: bool = False
    hazard: bool = False


def expected(words: Sequence[Token]) -> Expected:
    """What may follow these words of a requirement or a condition."""
    if not words:
        return Expected(clause=True)
    opened = next((index for index in reversed(range(len(words))) if words[index].kind == OPEN), None)
    if opened is not None:
        return _in_brackets(words, opened)
    last = words[-1]
    before = words[-2].text if len(words) > 1 else ""
    earlier = joined([word.text for word in words])
    text = last.text if last.kind not in (STRING, BRACED) else ""
    if (of_approval := _in_approval(words)) is not None:
        return of_approval
    if text == "," and (head := _begins_last(earlier, _CLAUSES)) in _LISTS:
        return _LISTS[head]
    head_of_event = _begins_last(_without_other_events(earlier), _HEADS_OF_EVENTS)
    if text == "or" and before in HAPPENINGS and head_of_event in _EVENTS:
        return _EVENT
    if text == "of" and _begins_last(earlier, (*_USES, "sum", "in", "with")) in _USES:
        return Expected(signal=True)
    if text == "of":
        if before == "sum" or _is_per(earlier[:-2]):
            return Expected(node=True)
        return Expected((*_EXPERIMENTS, TIME) if _has_time(earlier) else _EXPERIMENTS)
    if text == "by" and before == "followed":
        return replace(_EVENT, condition=True)
    if text == "and" and _begins_last(earlier, ("between", *_CONDITIONS)) == "between":
        return Expected(value=True)
    if text in HAPPENINGS and (head := _begins_last(_without_other_events(earlier[:-1]), _HEADS_OF_EVENTS)) in _EVENTS:
        if head in _AFTER_EVENT:
            return Expected((*_AFTER_EVENT[head], "or"))
        in_time = ("within",) if _is_answer(earlier) else ()
        return Expected(("or", *in_time), clause=True)
    if text == "with" and earlier[-1] == "ends with":
        return _CONDITION
    if _begins_last(earlier[:-1], _CLAUSES) == "visits" and (text == "in" or text not in _AFTER):
        return Expected(("order", "at least")) if text == "in" else Expected(("in order",), clause=True)
    if text in _AFTER:
        return _AFTER[text]
    if text in COMPARISONS or text in ("+", "-", "*", "/"):
        return Expected(operand=True)
    if last.kind in (NUMBER, QUANTITY):
        if is_window(earlier):
            return Expected(_EXPERIMENTS) if last.kind == NUMBER else Expected(clause=True)
        of = ("of",) if last.kind == QUANTITY and _is_per(earlier[:-1]) else ()
        return Expected((*_after_value(earlier), *of), clause=True)
    if last.kind in (NAME, STRING, CLOSE) or text in HAPPENINGS:
        if head_of_event == "followed" and text not in HAPPENINGS:
            return Expected((*_HAPPENINGS, *_AFTER_OPERAND, "within"), clause=True)
        if head_of_event in _EVENTS and text not in HAPPENINGS:
            return Expected(_HAPPENINGS)
        return Expected(_after_value(earlier), clause=True)
    return Expected(clause=True)


def _in_approval(words: Sequence[Token]) -> Expected | None:
    """What may follow in an approval; None in another clause, or after it."""
    begin = next((index for index in reversed(range(len(words))) if words[index].text == "approved"), None)
    written = [word.text for word in words[begin + 1 :] if word.kind != STRING] if begin is not None else []
    if begin is None or written != _APPROVAL[: len(written)] or len(words) == begin + 1:
        return None
    if words[-1].kind != STRING:
        return _A_TEXT
    following = _APPROVAL[len(written) : len(written) + 1]
    return Expected(tuple(following), clause=written != _APPROVAL[:1])


def opens_condition(words: Sequence[Token]) -> bool:
    """Whether a bracket after these words belongs to a condition: around a part of it, or after a function."""
    if words and words[-1].kind == OPEN:
        return True
    if not any(word in _BEFORE_CONDITIONS for word in joined([word.text for word in words])):
        return False
    wanted = _at_bracket(words[:-1] if _is_function(words[-1]) else words)
    return wanted.condition or wanted.operand


def joined(words: Sequence[str]) -> list[str]:
    """The words of a clause, a verb of two words as one."""
    together: list[str] = []
    for word in words:
        if together and f"{together[-1]} {word}" in VERBS:
            together[-1] += f" {word}"
        else:
            together.append(word)
    return together


def is_count(words: Sequence[str]) -> bool:
    """Whether a number at the end of these words is a count: `tries at most 3`, `runs at least 9`."""
    head = _begins_last(words, (*_CLAUSES, *COUNTING))
    if head not in _COUNTED | COUNTING:
        return False
    following = words[last_index(words, head) + 1 :]
    if head in COUNTING and "within" in following:
        return False
    return not {"per", "every"} & set(following) and _begins_last(following, ("if", "else", ",")) != "if"


def is_window(words: Sequence[str]) -> bool:
    """Whether a number at the end of these words is a window: `over last 200 runs`, `over last 7 d`."""
    return _begins_last(words, _CLAUSES) == "over"


def _in_brackets(words: Sequence[Token], opened: int) -> Expected:
    """What may follow in the innermost open brackets of a condition: no clause, for they are still open."""
    is_after = opened < len(words) - 1
    if opened and _is_function(words[opened - 1]):
        return Expected(signal=not is_after)
    if not is_after:
        return _at_bracket(words)
    wanted = replace(expected([word for word in words if word.kind != OPEN]), clause=False)
    inside = [word.text for word in words[opened + 1 :]]
    if words[opened - 1].text in _BEFORE_VALUES and words[-1].kind in (NAME, NUMBER, QUANTITY):
        if len(inside) == 1:
            return replace(wanted, words=(*_AFTER_OPERAND, "if"))
        if "if" in inside and "else" not in inside and inside[-1] not in _AFTER:
            return replace(wanted, words=("and", "or", "else"))
    return replace(wanted, words=_AFTER_OPERAND) if "else" in wanted.words else wanted


def _at_bracket(words: Sequence[Token]) -> Expected:
    """What may follow in a bracket after these words of a condition."""
    end = len(words)
    while end and words[end - 1].kind == OPEN:
        end -= 1
    if words[0].text == "context" and words[end - 1].text == ":":
        return _CONDITION
    return expected(words[:end])


def _is_function(word: Token) -> bool:
    return word.kind == NAME and word.text in FUNCTIONS


def _begins_last(words: Sequence[str], heads: Sequence[str]) -> str:
    """The one of some words that occurs last."""
    return next((word for word in reversed(words) if word in heads), "")


def _is_answer(words: Sequence[str]) -> bool:
    """Whether these words end in what follows an event, perhaps before its deadline."""
    return _begins_last([word for word in words if word not in HAPPENINGS], _CLAUSES) == "followed"


def _without_other_events(words: Sequence[str]) -> list[str]:
    """The words without what happens in each of several events but the last."""
    return [
        word for word, after in zip(words, [*words[1:], ""], strict=False) if word not in HAPPENINGS or after != "or"
    ]


def _after_value(words: Sequence[str]) -> tuple[str, ...]:
    head = _begins_last(words, _CLAUSES)
    if head in _USES and "of" not in words[last_index(words, head) :]:
        return ("of",)
    if is_count(words):
        return ("per", "if")
    if head in _REACTIONS and "after" not in words[last_index(words, head) :]:
        return ("after", "if")
    if head in ("in", "with"):
        return ("of runs", "of activations", *(("of time",) if _has_time(words) else ()))
    if head == "over":
        return _EXPERIMENTS
    if head == "never" and "for" in words[last_index(words, head) :]:
        return ("if",)
    if head in _CONDITIONS:
        return (*_AFTER_OPERAND, "for more than") if head == "never" else _AFTER_OPERAND
    if head == "verified" and words[-1] in METHODS:
        return ('""',)
    if head == "followed" and "within" not in words[last_index(words, head) :]:
        return (*_AFTER_OPERAND, "within")
    if "if" in words:
        return ("and", "or", "else")
    return ("if",) if head in _TIMED or head == "goal" else ()


def _is_per(words: Sequence[str]) -> bool:
    """Whether these words of a failure rate precede its time: `fails at most 1 per`."""
    return words[-1:] == ["per"] and _begins_last(words, (*_CLAUSES, *COUNTING)) == "fails"


def _has_time(words: Sequence[str]) -> bool:
    """Whether a share after these words may be one of the time: after `keeps` or `never`, perhaps a line above."""
    return _begins_last(words, tuple(VERBS)) in ("", "keeps", "never")


def last_index(words: Sequence[str], word: str) -> int:
    """The last index of a word; -1 if there is none."""
    return next((index for index in reversed(range(len(words))) if words[index] == word), -1)


_EXPERIMENTS = tuple(sorted(EXPERIMENTS))
_HAPPENINGS = tuple(sorted(HAPPENINGS))
_BOUNDS = ("at most", "at least", "less than", "more than", "between")
_COUNTED = words_of(operands=("count", "rate"))
_REACTIONS = words_of(operands=("reaction",))
_TIMED = words_of(operands=("duration", "deadline"))
_USES = words_of(operands=("use",))
_CONDITIONS = (*words_of(operands=("condition",)), "while", "when", "assuming", "context")
_BEFORE_CONDITIONS = frozenset((*_CONDITIONS, "if"))
_AFTER_OPERAND = ("and", "or", "<=", ">=", "<", ">", "==", "!=")
_BEFORE_VALUES = frozenset((*COMPARISONS, "+", "-", "*", "/"))
_EVENTS = (*words_of(operands=("event",)), "after", "from", "to", "until", "each", "followed")
_AFTER_EVENT = {"from": ("to", "until"), "each": ("is followed by",)}  # between two events
_CLAUSES = (
    *VERBS,
    *(
        "assuming",
        "in",
        "with",
        "confidence",
        "over",
        "on",
        "goal",
        "because",
        "verified",
        "from",
        "while",
        "when",
        "context",
        "each",
    ),
    *METADATA_HEADS,
)
_HEADS_OF_EVENTS = (*_EVENTS, *_CLAUSES)
_CONDITION = Expected(condition=True)
_VALUE = Expected(value=True)
_EVENT = Expected(("mission", "when"), node=True)
_A_TEXT = Expected(('""',))
_APPROVAL = ["by", "on", "of"]
_LISTS = {
    "refines": Expected(requirement=True),
    "mitigates": Expected(hazard=True),
    "verified": Expected(METHODS),
}
_OPERANDS = {
    **dict.fromkeys(("duration", "use", "count", "failures"), Expected(_BOUNDS)),
    "rate": Expected(("every", *_BOUNDS)),
    "deadline": Expected(("within", *_BOUNDS), clause=True),
    "reaction": Expected(("within",)),
    **dict.fromkeys(("condition", "stretch"), _CONDITION),
    "visits": Expected(node=True),
    "event": _EVENT,
    "answer": Expected(("by",)),
}
# The verbs of things that a mission does once, from its start to its end.
_OF_MISSIONS = [
    verb.word
    for verb in VERBS.values()
    if verb.judged in ("at its end", "while it runs") and verb.operand != "stretch"  # it begins as `never` does
]
_AFTER = {
    **{verb.word: _OPERANDS[verb.operand] for verb in VERBS.values()},
    "ends": Expected(("within", "with")),
    "starts": Expected(("within", *_BOUNDS)),
    **dict.fromkeys(("within", "goal", "most", "least", "than", "between", "else"), _VALUE),
    "at": Expected(("most", "least")),
    "less": Expected(("than",)),
    "more": Expected(("than",)),
    "for": Expected(("more than",)),
    **dict.fromkeys(("while", "when", "assuming", "if", "and", "or", "not"), _CONDITION),
    "on": Expected(("violation", AVERAGE)),
    "violation": Expected(ACTIONS),
    "verified": Expected(("by",)),
    "by": Expected(METHODS),
    "in": Expected(("at least",)),
    "with": Expected(("probability >=",)),
    "probability": Expected((">=", ">")),
    "over": Expected(("last",)),
    "sum": Expected(("of",)),
    **dict.fromkeys(("after", "from", "to", "until", "each"), _EVENT),
    "is": Expected(("followed by",)),
    "mission": Expected((*_OF_MISSIONS, *_HAPPENINGS)),
    "per": Expected(("run",), node=True),
    "every": Expected(value=True, node=True),
    "node": Expected(node=True),
    "confidence": Expected(("95 %", "99 %")),
    **dict.fromkeys(("because", "source"), _A_TEXT),
    "refines": _LISTS["refines"],
    "mitigates": _LISTS["mitigates"],
    "priority": Expected(("high", "medium", "low")),
    "approved": Expected(("by",)),
    ",": Expected(value=True, node=True),
    "/": Expected(node=True, operand=True),
}
