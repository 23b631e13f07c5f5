"""What may follow in scenarios: the grammar of docs/grammar.md, read backwards from the cursor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS
from btq_lang.grammar.scenario_words import ANSWERS, DURATIONS, RESULTS, TIMES, VERDICTS
from btq_lang.syntax.tokens import CLOSE, NAME, NUMBER, OPEN, QUANTITY, STRING, Token
from btq_lang.util.record import Record


class ExpectedStep(Record):
    """What may follow at a place of a scenario.

    Attributes:
        words: words and phrases of the grammar.
        behaviors_of: the last name of the nodes, of which a behavior follows; empty: no behavior does.
        nodes, kinds, trees, requirements, signals: names of these.
        ports_of: the name of a node in whose open brackets a port follows.
        has_bare_port: a port may follow there without a value.
        values_of: the name of a node, and its port, of which a value follows.
        value_of: a signal of which a value follows.
        clause: a claim follows, or goes on after these words.
        condition: a condition follows, or goes on after these words.
    """

    words: tuple[str, ...] = ()
    behaviors_of: str = ""
    nodes: bool = False
    kinds: bool = False
    trees: bool = False
    requirements: bool = False
    signals: bool = False
    ports_of: str = ""
    has_bare_port: bool = False
    values_of: tuple[str, str] | None = None
    value_of: str = ""
    clause: tuple[Token, ...] | None = None
    condition: tuple[Token, ...] | None = None


def expected_in_scenario(words: Sequence[Token]) -> ExpectedStep:
    """What may follow these words of a line of a scenario."""
    first, *rest = words
    if first.text == "scenario":
        return _in_head([word.text for word in rest])
    if (brackets := _open_brackets(words)) is not None:
        return brackets
    if first.text == "when":
        colon = next((index for index, word in enumerate(rest) if word.text == ":"), -1)
        return _in_trigger(rest) if colon < 0 else _in_effect(rest[colon + 1 :], is_change=True)
    return _in_effect(rest, is_change=False) if first.text == "given" else _in_expectation(rest)


def _in_head(words: list[str]) -> ExpectedStep:
    if not words:
        return ExpectedStep(('""',))
    last = words[-1]
    if last == "of":
        return ExpectedStep(trees=True)
    if last == "verifies" or (last == "," and "verifies" in words):
        return ExpectedStep(requirements=True)
    return ExpectedStep(tuple(word for word in ("of", "verifies") if word not in words and "verifies" not in words))


def _open_brackets(words: Sequence[Token]) -> ExpectedStep | None:
    """What may follow in the brackets after a node; None outside of any."""
    opened = next((index for index in reversed(range(len(words))) if words[index].kind in (OPEN, CLOSE)), None)
    if opened is None or words[opened].kind == CLOSE or words[opened - 1].kind not in (NAME, STRING):
        return None
    node = words[opened - 1].text.strip("\"'")
    inside = [word.text for word in words[opened + 1 :]]
    if inside[-1:] == ["="] and len(inside) > 1:
        return ExpectedStep(values_of=(node, inside[-2].strip("\"'")))
    if inside and inside[-1] != ",":
        return ExpectedStep()
    return ExpectedStep(ports_of=node, has_bare_port=words[0].text == "expect")


def _in_effect(words: Sequence[Token], is_change: bool) -> ExpectedStep:
    """A behavior of nodes, or a value."""
    texts = [word.text for word in words]
    if not words:
        return ExpectedStep(("every", *(("mission halts",) if is_change else ())), nodes=True, signals=True)
    if texts == ["mission"]:
        return ExpectedStep(("halts",))
    if texts[-1] == "=":
        return ExpectedStep(value_of=texts[0]) if len(texts) == 2 else ExpectedStep()
    if (names := _names(words)) is None:
        return ExpectedStep(kinds=texts[-1] == "every", nodes=texts[-1] == "/")
    node, after = names
    return _after_nodes(node, [word.text for word in words[after:]], words[-1])


def _names(words: Sequence[Token]) -> tuple[str, int] | None:
    """The last name of the nodes at the start, and the index of the word after them and their brackets; None: another
    name must follow."""
    index = 1 if words[0].text == "every" and words[0].kind == NAME else 0
    while index < len(words) and words[index].kind in (NAME, STRING):
        node = words[index].text.strip("\"'")
        index += 1
        if index == len(words) or words[index].text != "/":
            if index < len(words) and words[index].kind == OPEN:
                closing = next((at for at in range(index, len(words)) if words[at].kind == CLOSE), len(words) - 1)
                index = closing + 1
            return node, index
        index += 1
    return None


def _after_nodes(node: str, texts: list[str], last: Token) -> ExpectedStep:
    if not texts or last.text == "then":
        return ExpectedStep(behaviors_of=node)
    if "writes" in texts and last.text not in (",", "then"):
        return ExpectedStep()
    if last.text == "answers" or (last.text == "," and texts[-2:-1] and texts[-2] in ANSWERS):
        return ExpectedStep((*ANSWERS, *(("then",) if last.text == "," else ())))
    if last.text == ",":
        return ExpectedStep(("then",), behaviors_of=node)
    if last.text in ("does", "not", "and"):
        return ExpectedStep(({"does": "not end", "not": "end", "and": "writes"}[last.text],))
    if last.kind == NUMBER or last.text in DURATIONS:
        return ExpectedStep(("times",) if last.kind == NUMBER else ())
    begun = texts[max((index for index, text in enumerate(texts) if text in (",", "then")), default=-1) + 1 :]
    further: list[str] = []
    if not any(text in DURATIONS for text in begun) and "answers" not in begun:
        further.append("after")
    if not any(text in RESULTS for text in begun):
        further += [*RESULTS[:3], "does not end"]
    if last.text not in (*TIMES, "times") and not last.text.endswith(" times"):
        further += TIMES
    return ExpectedStep((*further, "and writes"))


def _in_trigger(words: Sequence[Token]) -> ExpectedStep:
    if not words:
        return ExpectedStep(("mission", "every"), nodes=True, condition=())
    last = words[-1]
    if len(words) == 1 and last.kind == QUANTITY:
        return ExpectedStep(("have passed",))
    if last.text in HAPPENINGS:
        return ExpectedStep(("for the first time", "for the second time"))
    if last.text in ("have", "for", "the"):
        return ExpectedStep({"have": ("passed",), "for": ("the",), "the": ("first", "second", "third")}[last.text])
    if last.text in ("first", "second", "third") or (last.kind == NUMBER and "for" in [word.text for word in words]):
        return ExpectedStep(("time",))
    if last.text == "/":
        return ExpectedStep(nodes=True)
    names = _names(words)
    is_event = (names is not None and names[1] == len(words)) or [word.text for word in words] == ["mission"]
    return ExpectedStep(tuple(sorted(HAPPENINGS)) if is_event else (), condition=tuple(words))


def _in_expectation(words: Sequence[Token]) -> ExpectedStep:
    if not words:
        heads = ("mission", "mission fails", "mission halts", "mission does not end", "never node", "every", "finally")
        return ExpectedStep(heads, requirements=True, nodes=True, clause=())
    texts = [word.text for word in words]
    if texts[0] == "finally":
        return ExpectedStep(condition=tuple(words[1:]))
    if texts[-1] == "every" and len(texts) == 1:
        return ExpectedStep(kinds=True)
    if "runs" in texts and texts[-1] in ("runs", ",") and (names := _names(words)) is not None:
        port = words[names[1] - 2].text if words[names[1] - 1].kind == CLOSE else ""
        wanted = ExpectedStep(values_of=(names[0], port.strip("\"'")))
        return wanted if texts[-1] == "," else ExpectedStep(values_of=wanted.values_of, clause=tuple(words))
    if texts == ["mission", "does"] or texts == ["mission", "does", "not"]:
        return ExpectedStep(("not end" if texts[-1] == "does" else "end",))
    names = _names(words)
    if names is not None and names[1] == len(words):
        verdicts = tuple(" ".join(verdict) for verdict in VERDICTS) if len(words) == 1 and texts[0] != "mission" else ()
        return ExpectedStep((*verdicts, *_VERBS), clause=tuple(words))
    return ExpectedStep(clause=tuple(words))


_VERBS: Final = tuple(sorted(VERB_WORDS))
