"""Classic placeholders: script nodes without code, which represent skills (docs/language.md)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, lookup, spellings
from btq_lang.checks import lookups
from btq_lang.checks.view import View, has_names
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import HEADS
from btq_lang.syntax.tokens import CATEGORIES, DIRECTIONS, NODE_CLAUSES
from btq_lang.syntax.tree import Node, Pair, Tree, Word, is_name, quote
from btq_lang.util.spelling import near
from btq_lang.util.text import LINE_END, Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

_BLANKS = " \t"
_AFTER_NAME = r"[ \t]*(?:,[ \t]*)?(?P<closing>[ \t\r\n]*\))?"  # compiled when the first file needs it
_OPERATOR = re.compile(r"[<>=]|&&|\|\|")  # a name that is a script has one of these
# Words that mean something else in the place of a node's kind or label.
_NOT_A_KIND = CATEGORIES | NODE_CLAUSES | DIRECTIONS | HEADS | VERB_WORDS | {"xml"}


def classic_placeholder(view: View) -> Iterator[Diagnostic]:
    """A placeholder, with its short form."""
    for resolved in view.seen.placeholders:
        if resolved.name is None or resolved.node.kind is None:
            continue
        name = _id_of(resolved.name.text)
        if _why_taken(view, name) is not None:
            continue  # reported as a clash
        if _is_script(view, resolved.name.text):
            yield _code_as_name(resolved.node, resolved.node.kind, resolved.name)
            continue
        what = "the condition" if resolved.category == "Condition" else "the action"
        fix = _short_form(view, resolved, name)
        message = f"`{resolved.node.kind.text}` without code is a placeholder for {what} `{name}`"
        yield Diagnostic(
            "classic-placeholder", resolved.node.kind.span, message, fixes=(fix,) if fix is not None else ()
        )


def _is_script(view: View, name: str) -> bool:
    """Whether a name can only be meant as code: `speed := 0.5`, `battery > 20`."""
    if _OPERATOR.search(name) is None:
        return False
    from btq_lang.syntax.script.tree import Assign, ScriptBinary, ScriptComparison  # few files need it

    script = view.script(name)
    ends = (script.statements[-1],) if script.complete and script.statements and not script.problems else ()
    return any(isinstance(end, Assign | ScriptComparison | ScriptBinary) for end in ends)


def _code_as_name(node: Node, kind: Word, name: Word) -> Diagnostic:
    """`Script "speed := 0.5"` is not a placeholder: its code lacks the port."""
    message = f"`{name.text}` is the name of this `{kind.text}`; a script goes in its port `code`"
    key = next((pair.key for pair in node.attributes if pair.value is name), None)
    code = f"code = {name.raw if name.quoted else quote(name.text)}"
    fixes: tuple[Fix, ...] = ()
    if key is not None:
        fixes = (replace_fix("Replace `name` with `code`", key.span, "code"),)
    elif not node.attributes:
        fixes = (replace_fix(f"Write `{kind.text} ({code})`", name.span, f"({code})"),)
    return Diagnostic("classic-placeholder", name.span, message, fixes=fixes, severity=Severity.WARNING)


def placeholder_clash(view: View) -> Iterator[Diagnostic]:
    """A name that becomes the ID of another placeholder, of a built-in node or of a tree."""
    for resolved in view.seen.placeholders:
        name = resolved.name
        if name is None:
            continue
        legal = _id_of(name.text)
        reason = _why_taken(view, legal)
        other = view.ask(_first_name, legal)
        if reason is not None:
            yield Diagnostic("placeholder-clash", name.span, f"`{name.text}` becomes the node ID `{legal}`, {reason}")
        elif other != name.text and (first := view.ask(_first_place, legal)) is not None:
            message = f"`{other}` and `{name.text}` both become the node ID `{legal}`"
            yield Diagnostic("placeholder-clash", name.span, message, related=(Related(first, "first one"),))


def _first_name(store: Store[Workspace], viewpoint: str, legal: str) -> str | None:
    """The name of the first placeholder in scope that becomes an ID."""
    return store.ask(_first_names, viewpoint).get(legal)


@hub
def _first_names(store: Store[Workspace], viewpoint: str) -> dict[str, str]:
    names: dict[str, str] = {}
    for _, tree in reversed(store.ask(inputs.trees, viewpoint)):
        names.update(store.ask(_names_in, tree))
    return names


def _first_place(store: Store[Workspace], viewpoint: str, legal: str) -> Place | None:
    """The place of that placeholder's name."""
    for path, tree in store.ask(inputs.trees, viewpoint):
        if legal in store.ask(_names_in, tree):
            name = next(name for name in _placeholders(tree) if _id_of(name.text) == legal)
            return Place(name.span, path, tree.item)
    return None


def _names_in(_: Store[Workspace], tree: Facts) -> dict[str, str]:
    """The IDs that the placeholders of a tree become, each with the first name that becomes it."""
    return {_id_of(name.text): name.text for name in reversed([*_placeholders(tree)])}


def _placeholders(tree: Facts) -> Iterator[Word]:
    for node in tree.item.walk() if isinstance(tree.item, Tree) else ():
        if is_placeholder(node) and (name := node.name) is not None:
            yield name


@lru_cache(10_000)
def _id_of(name: str) -> str:
    """The ID that a placeholder's name becomes; cached, as a mission repeats the names of skills."""
    return legal_name(name)


def _why_taken(view: View, name: str) -> str | None:
    """Why a placeholder cannot become a node of this ID."""
    if name in BUILTINS:
        return "which is a built-in node"
    return "which is the name of a tree" if view.ask(lookups.is_defined, Kind.TREE, name) else None


def _short_form(view: View, resolved: ResolvedNode, name: str) -> Fix | None:
    """The fix that writes `MoveBase (…)`, `Condition BatteryLow "BatteryLow?"`; None if the name is not in its usual
    place.

    It is safe if no models are in scope: with models the node would be checked against them.
    """
    node = resolved.node
    if view.entry.diagnostics or node.children or node.kind is None or node.name is None:
        return None
    head = _as_kind(name)
    if resolved.category == "Condition" or _looks_like_builtin(name):
        head = f"{resolved.category} {head}"
    if (label := node.name).text != name:
        is_label = label.quoted or (is_name(label.raw) and label.raw not in _NOT_A_KIND)
        head = f"{head} {label.raw if is_label else quote(label.text)}"
    changes = _replace_head(view.text, node, head)
    if changes is None:
        return None
    return Fix(f"Write `{head}`", changes, not view.ask(has_names, Kind.MODEL))


def _as_kind(name: str) -> str:
    is_plain = is_name(name) and name not in _NOT_A_KIND and lookup(name) is None and name not in KNOWN_WORDS
    return name if is_plain else quote(name)


@lru_cache(1000)
def _looks_like_builtin(name: str) -> bool:
    """Whether a node of that name would be taken for a misspelt one of the engine's."""
    return bool(near(name, (spelling for kind in BUILTINS.values() for spelling in spellings(kind))))


def _replace_head(text: str, node: Node, head: str) -> tuple[FixEdit, ...] | None:
    """The changes that put `head` in place of the kind and the name."""
    assert node.kind is not None, "a placeholder has a kind"
    names = [pair for pair in node.attributes if pair.key.text == "name"]
    if node.label is not None:
        if names or text[node.kind.end : node.label.start].strip(_BLANKS):
            return None
        return (FixEdit(Place(Span(node.kind.start, node.label.end)), head),)
    if len(names) != 1 or names[0] is not node.attributes[0]:
        return None
    return _without_name(text, node.kind, names[0], head)


def _without_name(text: str, kind: Word, name: Pair, head: str) -> tuple[FixEdit, ...] | None:
    """The changes that replace the kind and remove the name from the brackets, where it comes first; empty brackets go
    too."""
    before, after = text[kind.end : name.span.start], re.compile(_AFTER_NAME).match(text, name.span.end)
    if before.strip() != "(" or after is None:
        return None
    if after["closing"]:
        return (FixEdit(Place(Span(kind.start, after.end())), head),)
    start, end = name.span.start, after.end()
    above, line_end = before.rstrip(_BLANKS), LINE_END.match(text, end)
    if line_end is not None and above.endswith(("\r", "\n")):
        start, end = kind.end + len(above), line_end.end()  # the name has a line of its own
    return FixEdit(Place(kind.span), head), FixEdit(Place(Span(start, end)), "")
