"""Completion: what may follow at the cursor, best first; documentation is computed on request.

One invariant: the proposals depend on the place alone, never on the letters typed so far, for each editor filters by
these in its own way.  How they narrow the list is for `completion_list`.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.catalog.qualities import EDITIONS
from btq_lang.catalog.verbs import VERBS
from btq_lang.grammar.conditions import HEADS
from btq_lang.grammar.hazards import HAZARD_HEADS
from btq_lang.grammar.scenario_words import STEPS
from btq_lang.ide import node_proposals as of_nodes
from btq_lang.ide import proposals as offer
from btq_lang.ide.clause_words import Expected, expected, is_count, is_window
from btq_lang.ide.completion_list import listed
from btq_lang.ide.meaning import entry_at
from btq_lang.ide.measures import MeasuredValue, measured_at
from btq_lang.ide.place import CursorPlace, LineNode, item_tokens, open_brace, place_at, word_text
from btq_lang.ide.proposals import Proposal
from btq_lang.ide.scenario_proposals import of_step
from btq_lang.ide.scenario_words import expected_in_scenario
from btq_lang.ide.snippets import snippets_for
from btq_lang.ide.xml_completion import complete_in_xml
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tokens import (
    CATEGORIES,
    CLOSE,
    COMMENT,
    NAME,
    NODE_CLAUSES,
    NUMBER,
    OPERATOR,
    QUANTITY,
    STRING,
    Token,
)
from btq_lang.syntax.tree import is_name
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span
from btq_lang.workspace.file import File
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


class Completion(Record):
    """What may follow at a place, best first.  span: what a proposal replaces unless it has a span of its own."""

    span: Span
    proposals: tuple[Proposal, ...]


def complete(
    workspace: Workspace, path: str, offset: int, *, asked: bool = True, trigger: str = "", snippets: bool = True
) -> Completion:
    """What may follow at an offset of a file as the editor has it; the spans of the result count there too.

    Args:
        asked: whether the user requests it; otherwise the editor does, because of what was typed.
        trigger: the character that made the editor request it.
        snippets: whether the editor supports snippets.
    """
    text = workspace.files[path].source
    if workspace.files[path].is_foreign:
        completion = Completion(*complete_in_xml(workspace, path, offset))
        proposals = list(completion.proposals)
    else:
        place = place_at(workspace, path, offset)
        if not asked and _ends_something(place, text[:offset], trigger):
            return Completion(Span(offset, offset), ())
        completion = _complete(workspace, path, place, offset)
        labelled = (one for one in completion.proposals if one.label)
        proposals = [one for one in labelled if not _is_typed_here(workspace, path, completion.span, one)]
    if not snippets:
        proposals = [replace(one, snippet=None) for one in proposals if one.kind != "snippet"]
    return Completion(completion.span, listed(proposals, text[completion.span.start : offset], asked))


def _ends_something(place: CursorPlace, before: str, trigger: str) -> bool:
    """Whether a typed character closes a string or belongs to a number, so that nothing begins after it."""
    return (trigger == '"' and place.inside != "string") or (trigger == "." and before[-2:-1].isdecimal())


def _is_typed_here(workspace: Workspace, path: str, span: Span, proposal: Proposal) -> bool:
    """Whether a name occurs only in the word that is being typed."""
    name = proposal.label.strip("{}")
    if proposal.kind not in ("node", "instance", "tag", "key") or proposal.include or lookup(name) is not None:
        return False
    file = workspace.files[path]
    if name not in file.text[span.start : span.end] or _is_elsewhere(file, span, name):
        return False
    others = (file for other, file in workspace.files.items() if other != path and name in file.text)
    return not any(any(file.mentioned(name)) for file in others)


def _is_elsewhere(file: File, span: Span, name: str) -> bool:
    """Whether a name also occurs outside a span.  Mostly the tokens suffice: a tree has many words."""
    if is_name(name):
        for occurrence in re.finditer(rf"(?<!\w){re.escape(name)}(?!\w)", file.text):
            if span.start <= occurrence.start() < span.end:
                continue
            tokens = item_tokens(file, occurrence.start())
            token = tokens[bisect_right(tokens, occurrence.start(), key=lambda token: token.start) - 1]
            if token.kind == NAME and token.text == name:
                return True
            if token.kind not in (NAME, COMMENT):  # for quotes and braces, that depends on their contents
                break
        else:
            return False
    places = (mention.span.shifted(entry.start) for entry, mention in file.mentioned(name))
    return any(place.start < span.start or place.end > span.end for place in places)


def _complete(workspace: Workspace, path: str, place: CursorPlace, offset: int) -> Completion:
    text = workspace.files[path].text
    special = _in_comment(place, offset) or _in_braces(workspace, path, place, text, offset)
    special = special or _in_string(workspace, path, place, text, offset) or _unit(workspace, path, place, text, offset)
    if special is not None:
        return special
    proposals = _unique(_in_code(workspace, path, place, offset))
    if text[offset - 1 : offset] in (":", ",") and place.span.start == offset:
        proposals = tuple(map(_with_blank, proposals))
    if text[place.span.end : place.span.end + 2].lstrip(" ").startswith("("):  # the brackets are there already
        proposals = tuple(replace(one, snippet=None) for one in proposals)
    return Completion(place.span, proposals)


def _with_blank(proposal: Proposal) -> Proposal:
    """The proposal after a sign that needs a blank: an editor that goes on with the list after one replaces it, too."""
    return replace(
        proposal, insert=f" {proposal.insert}", snippet=None if proposal.snippet is None else f" {proposal.snippet}"
    )


def _unique(proposals: Iterable[Proposal]) -> tuple[Proposal, ...]:
    return tuple({one.label: one for one in reversed(tuple(proposals))}.values())[::-1]


# ---- inside comments, braces, strings, and after numbers ----


def _in_comment(place: CursorPlace, offset: int) -> Completion | None:
    if place.inside != "comment":
        return None
    listed = re.search(r"btq:\s*ignore\s*\[(?:[^\]]*,)?\s*([\w-]*)$", place.text)
    if listed:
        return Completion(Span(offset - len(listed[1]), offset), tuple(offer.rules()))
    begun = re.search(r"(btq:?\s*\w*)$", place.text)
    ignore = Proposal("btq: ignore[…]", "keyword", "silence a rule on this line", "btq: ignore[]", "btq: ignore[$0]")
    return Completion(Span(offset - len(begun[1]) if begun else offset, offset), (ignore,) if begun else ())


def _in_braces(workspace: Workspace, path: str, place: CursorPlace, text: str, offset: int) -> Completion | None:
    """`{` and what may follow: entries of the blackboard; after `{@` those of the root's."""
    begun = open_brace(text, offset)
    if begun is None or place.inside == "comment":
        return None
    entry = entry_at(workspace, path, offset)
    keys = [] if entry is None else list(offer.keys(workspace, path, entry, begun.is_root))
    if not begun.is_root and place.node is not None:
        keys.insert(0, of_nodes.SAME_ENTRY)
    return Completion(begun.span, tuple(replace(one, insert=f"{one.insert}{begun.closing}") for one in keys))


def _in_string(workspace: Workspace, path: str, place: CursorPlace, text: str, offset: int) -> Completion | None:
    if place.inside != "string":
        return None
    if place.words and place.words[0].text == "include":
        return Completion(Span(offset - len(place.text), offset), tuple(offer.includes(workspace, path, quoted=False)))
    key = place.key
    entry = entry_at(workspace, path, offset)
    if key is not None and entry is not None and of_nodes.is_script(workspace, path, place.node, key):
        typed, proposals = of_nodes.in_script(workspace, path, entry, place.text)
        return Completion(Span(offset - typed, offset), proposals)
    whole = Span(offset - len(place.text) - 1, offset)
    in_list = place.last in ("satisfies", "satisfices", ",") or place.block == "scenario"
    if key in ("ID", "Quality", "main_tree_to_execute") or in_list:
        proposals = _unique(_in_code(workspace, path, place, offset))
        end = re.match(r"[^\"'\r\n]*[\"']?", text[offset:])
        quoted = (
            replace(one, insert=offer.quoted(one.insert), snippet=None, filter=f'"{one.label}') for one in proposals
        )
        return Completion(Span(whole.start, offset + (len(end[0]) if end else 0)), tuple(quoted))
    return Completion(whole, ())


def _unit(workspace: Workspace, path: str, place: CursorPlace, text: str, offset: int) -> Completion | None:
    """Units after a number; those that fit the port, signal or verb come first.  After a count none; after the number
    of a window, what it may count comes first."""
    line = text[line_start(text, 0, offset) : offset]
    begun = re.search(rf"(?:^|[^\w.])\d+(?:\.\d+)?(?:[eE][+-]?\d+)?([ \t]*)({_BEGUN_UNIT}|)$", line)
    if begun is not None:
        # Without its unit, in which `/` is not a division.
        place = _before_unit(place_at(workspace, path, offset - len(begun[2])) if begun[2] else place)
    if begun is None or place.inside != "code" or not place.words:
        return None
    is_of_item = place.words[0].text in ("QualityReq", "signal", "context", "apply")
    if place.block in ("items", "none", "ports") and not is_of_item:
        return None
    in_brackets = place.depth > 0 and place.node is not None
    if in_brackets and not (place.last == "=" or (place.group and place.group[-1].kind in (NUMBER, QUANTITY))):
        return None
    measured = MeasuredValue()
    if in_brackets and place.node is not None:
        before = [word.text for word in place.group if word.kind in (NAME, STRING, OPERATOR)]
        key = (
            before[before.index("=") - 1]
            if "=" in before[:-1]
            else place.key or (before[-2] if len(before) > 1 else "")
        )
        unit = of_nodes.port_unit(workspace, path, place.node, key)
        measured = MeasuredValue("s" if unit == "ms" else unit, is_certain=True)  # btq adds the milliseconds
        if begun[1] and measured.unit is None:
            return None  # `num_attempts = 6 |`: the next attribute
    else:
        measured = measured_at(workspace, path, place)
    separator = "" if begun[1] else " "
    clause = [word.text for word in place.group]
    fitting = () if not in_brackets and is_count(clause) else offer.units(measured)
    units = tuple(replace(one, insert=f"{separator}{one.insert}") for one in fitting)
    following = () if not begun[1] else _unique(_in_code(workspace, path, place, offset))
    proposals = (*following, *units) if not in_brackets and is_window(clause) else (*units, *following)
    return Completion(Span(offset - len(begun[2]), offset), proposals)


def _before_unit(place: CursorPlace) -> CursorPlace:
    """The place as it would be without the unit of its last number."""
    if not place.words or place.words[-1].kind != QUANTITY:
        return place
    whole = place.words[-1]
    match = re.match(r"[+-]?[\d.]+(?:[eE][+-]?\d+)?", whole.text)
    number = Token(NUMBER, whole.start, match[0] if match else "")
    group = (*place.group[:-1], number) if place.group[-1:] == (whole,) else place.group
    return replace(place, words=(*place.words[:-1], number), group=group)


_BEGUN_UNIT = r"(?:[^\W\d_]+|%|1(?=/))(?:[*/^][^\W_]*)*"


# ---- in code ----


def _in_code(workspace: Workspace, path: str, place: CursorPlace, offset: int) -> Iterator[Proposal]:
    words = place.words
    if not words:
        yield from _line_heads(workspace, path, place)
        return
    first = words[0].text if words[0].kind == NAME else ""
    if place.is_of_parameters:
        yield from offer.units_of_names() if place.last == ":" else ()
    elif place.block in ("items", "models"):
        yield from _in_item(workspace, path, place, first)
    elif place.block == "ports":
        yield from offer.port_words(place)
    elif place.block == "scenario":
        yield from _in_scenario(workspace, path, place)
    elif place.block == "hazard":
        yield from offer.words(('""',) if place.last in ("source", "because") else (), "keyword")
    elif place.block == "clauses" or any(each.kind == NAME and each.text == "QualityReq" for each in place.group):
        yield from _in_requirement(workspace, path, place)
    elif place.block == "tree" and first in ("input", "output", "inout"):
        yield from offer.port_words(place)
    elif place.block in ("tree", "node"):
        yield from _in_node(workspace, path, place, first)


def _line_heads(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    """What a line may begin with."""
    if place.block == "items":
        yield from offer.item_words(workspace, path)
    elif place.block == "models":
        yield from offer.category_words()
    elif place.block == "ports":
        yield from offer.port_heads()
    elif place.block == "hazard":
        yield from (offer.keyword(word) for word in HAZARD_HEADS)
    elif place.block == "scenario":
        yield from (offer.keyword(word) for word in STEPS)
    elif place.block == "clauses":
        yield from _clause_words(workspace, path, Expected(clause=True), place)
    elif place.block in ("tree", "node"):
        yield from of_nodes.nodes(workspace, path)
        yield from offer.node_clause_words()
        if place.block == "tree":
            yield from offer.port_heads()
    yield from snippets_for(place.block)


def _in_item(workspace: Workspace, path: str, place: CursorPlace, first: str) -> Iterator[Proposal]:
    last = place.last
    if len(place.words) == 1 and first in _DECLARED:
        yield from offer.undeclared(workspace, path, *_DECLARED[first])
    elif first == "include":
        yield from offer.includes(workspace, path, quoted=True) if len(place.words) == 1 else ()
    elif first == "qualities":
        yield from offer.words(EDITIONS, "enum")
    elif first == "quality":
        yield from _others(offer.qualities(workspace, path, place), place) if last in (":", ".") else ()
    elif first == "signal":
        yield from _in_signal(place, last)
    elif first == "context":
        wanted = Expected(condition=True) if last == ":" else replace(expected(place.group), clause=False)
        yield from _others(_clause_words(workspace, path, wanted, place), place)
    elif first == "Root":
        yield from of_nodes.trees(workspace, path)
    elif first == "QualityReq":
        yield from _in_requirement(workspace, path, place)
    elif first in ("scenario", "given"):
        yield from _in_scenario(workspace, path, place)
    elif first == "apply":
        yield from _in_apply(workspace, path, place)
    elif first in CATEGORIES and len(place.words) == 1:
        yield from of_nodes.unknown_nodes(workspace, path)


def _others(proposals: Iterable[Proposal], place: CursorPlace) -> Iterator[Proposal]:
    """All but the quality or the context that the line defines."""
    own = [word_text(word) for word in place.words[1:2]]
    yield from (one for one in proposals if one.label not in own or one.kind not in ("quality", "context"))


def _in_signal(place: CursorPlace, last: str) -> Iterator[Proposal]:
    if last == ":":
        yield from offer.units_of_names()
    elif len(place.words) >= 4 and last not in ("/", "*", "^"):
        texts = {word.text for word in place.words}
        wanted = (word for word in ("from {}", "level", "counter", "gauge", "fresh within", "initially"))
        yield from offer.words((word for word in wanted if word.split()[0] not in texts), "keyword")


def _in_apply(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    words = [word.text for word in place.words]
    if place.depth:
        yield from offer.parameters(workspace, path, place.callee) if place.last != "=" else ()
    elif "to" not in words:
        if place.last in ("apply", ","):
            yield from offer.requirements(workspace, path)
        else:
            yield from offer.words(("to",), "keyword")
    elif place.last == "tagged":
        yield from offer.tags(workspace, path)
    elif place.last == "every":
        yield from offer.kinds(workspace, path)
    elif place.last in ("to", "except", ",", "under", "/"):
        yield from offer.words(("every", "every node tagged"), "keyword") if place.last in ("to", "except", ",") else ()
        yield from offer.node_names(workspace, path)
    elif "except" not in words:
        yield from offer.words(("under", "except"), "keyword")


def _in_requirement(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    """What may follow `QualityReq` on its line, in brackets, or in its block."""
    words = place.group
    if (visited := _visited(place)) is not None:
        given = tuple(word.text for word in words)
        ports = of_nodes.ports_of_line(workspace, path, visited) if given[-1:] in ((), (",",)) else ()
        yield from of_nodes.ports(ports, given, visited)
        return
    head = next((index for index in reversed(range(len(words))) if words[index].text == "QualityReq"), None)
    if head is not None:
        following = [word.text for word in words[head + 1 :]]
        if not following:
            yield from offer.words(('ID = "" description = ""',), "keyword") if place.depth else ()
            yield from offer.undeclared(workspace, path, *_DECLARED["QualityReq"])
            return
        if following[-1] in (":", ".", "and") and VERBS.keys().isdisjoint(following) and HEADS.isdisjoint(following):
            yield from offer.qualities(workspace, path, place)
            return
        if following == ["ID", "="]:
            yield from offer.requirements(workspace, path)
            return
        if len(following) == 3 and following[0] == "ID":
            yield from offer.words(('description = ""',), "keyword")
            return
    yield from _clause_words(workspace, path, expected(words), place)


def _in_scenario(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    """What may follow on the first line of a scenario, and on those of its steps."""
    wanted = expected_in_scenario(place.words)
    yield from of_step(workspace, path, place, wanted)
    if wanted.condition is not None:
        words = (Token(NAME, 0, "when"), *wanted.condition)
    elif wanted.clause:
        words = wanted.clause
    else:
        yield from offer.words(_CLAIMS, "keyword") if wanted.clause is not None else ()
        return
    yield from _clause_words(workspace, path, replace(expected(words), clause=False), place)


def _visited(place: CursorPlace) -> LineNode | None:
    """The node after `visits` whose brackets are open."""
    texts = [word.text for word in place.words]
    opened = next((index for index in reversed(range(len(texts))) if texts[index] in ("(", ")")), 0)
    if "visits" not in texts[:opened] or texts[opened] == ")" or "QualityReq" in texts[opened:]:
        return None
    return LineNode(word_text(place.words[opened - 1]), place.words[opened - 1].kind == STRING, None)


def _clause_words(workspace: Workspace, path: str, expectation: Expected, place: CursorPlace) -> Iterator[Proposal]:
    """What the grammar of clauses expects."""
    yield from offer.words(expectation.words, "keyword")
    if expectation.condition:
        yield from offer.operands(workspace, path, place, MeasuredValue())
        yield from offer.words(("not", "node", *_FUNCTIONS), "keyword")
    elif expectation.operand or expectation.value:
        yield from offer.operands(workspace, path, place, measured_at(workspace, path, place), contexts=False)
        yield from offer.words(_FUNCTIONS if expectation.operand else (), "keyword")
    if expectation.signal:
        yield from offer.signals(workspace, path)
    if expectation.requirement:
        yield from offer.requirement_ids(workspace, path, place)
    if expectation.hazard:
        yield from offer.hazards(workspace, path)
    if expectation.requirement or expectation.hazard:
        yield from offer.external_ids(workspace, place)
    if expectation.node and place.last == "every":
        yield from offer.kinds(workspace, path)
    elif expectation.node:
        yield from offer.node_names(workspace, path)
    if expectation.clause and not _lacks_unit(workspace, path, place):
        yield from offer.clauses(tuple(word.text for word in place.words))
        yield from offer.node_names(workspace, path)


def _lacks_unit(workspace: Workspace, path: str, place: CursorPlace) -> bool:
    """Whether the number before the cursor needs a unit, without which no clause can follow."""
    if not place.group or place.group[-1].kind != NUMBER or is_count([word.text for word in place.group]):
        return False
    return measured_at(workspace, path, place).unit != "1"


def _in_node(workspace: Workspace, path: str, place: CursorPlace, first: str) -> Iterator[Proposal]:
    if place.depth == 0 and len(place.words) == 1 and first in CATEGORIES:
        yield from of_nodes.of_category(workspace, path, first)
        return
    list_word = _open_list(place)
    if list_word is not None:
        yield from _in_list(workspace, path, place, list_word)
        return
    node = place.node
    if place.depth == 0:
        yield from offer.node_clause_words()
        return
    if node is None:
        yield from offer.parameters(workspace, path, place.callee) if place.last != "=" else ()
        return
    ports = of_nodes.ports_of_line(workspace, path, node)
    key = place.key
    if key is None:
        yield from of_nodes.ports(ports, place.given, node)
        yield from of_nodes.attributes(place.given, node)
        yield from offer.node_clause_words()
    elif key == "ID" and node.is_subtree:
        yield from of_nodes.trees(workspace, path)
    elif key in RESERVED_ATTRIBUTES:
        yield from of_nodes.attribute_values(key)
    elif key in ("ID", "name"):
        return
    else:
        entry = entry_at(workspace, path, place.span.start)
        yield from of_nodes.port_values(
            workspace, path, entry, next((port for port in ports if port.name == key), None)
        )


def _open_list(place: CursorPlace) -> str | None:
    """The list of qualities, requirements or tags that goes on here: after its word, a comma, a `.` or `Quality =`."""
    words = place.group
    if not words or words[-1].kind == CLOSE:
        return None
    last = words[-1].text
    if last not in (",", ".", "<", "=", *NODE_CLAUSES):
        return None
    if last == "=" and (len(words) < 2 or words[-2].text != "Quality"):
        return None
    return next((word.text for word in reversed(words) if word.kind == NAME and word.text in NODE_CLAUSES), None)


def _in_list(workspace: Workspace, path: str, place: CursorPlace, word: str) -> Iterator[Proposal]:
    if word == "satisfices":
        yield from offer.qualities(workspace, path, place)
    elif word == "satisfies":
        yield from offer.requirements(workspace, path)
        yield from offer.words(("QualityReq",), "keyword")
    else:
        yield from offer.tags(workspace, path)


_CLAIMS = tuple(verb.word for verb in VERBS.values() if " " not in verb.word)
_FUNCTIONS = ("max()", "min()", "mean()", "p95()", "age()")
_DECLARED = {
    "BehaviorTree": (Kind.TREE, What.TREE),
    "SubTree": (Kind.TREE, What.TREE),
    "QualityReq": (Kind.REQUIREMENT, What.REQUIREMENT),
    "signal": (Kind.SIGNAL, What.VALUE),
    "context": (Kind.CONTEXT, What.VALUE),
    "quality": (Kind.QUALITY, What.QUALITY),
    "hazard": (Kind.HAZARD, What.HAZARD),
}  # the words that declare a name, and the kinds of references to it
