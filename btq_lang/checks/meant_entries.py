"""Values that are meant as entries, but are texts to the engine, or entries of other names: `goal`, `{goal`, `$goal`,
`@{goal}`, `{ goal }`, `{goal.x}`.

One invariant: a bare word is reported only if its port makes a text unlikely, for a text may equal the name of an
entry, or in a tree that has all its texts in quotes; never a literal of any type, nor the default of its port.
Sources: isBlackboardPointer and stripBlackboardPointer in src/tree_node.cpp of 4.6.2 and 4.10.0.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.catalog.kinds import PortKind
from btq_lang.catalog.literals import OLD_ENTRY, check_literal, is_own_value, is_pointer, plain_type
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.versions import OUTPUT_IN_BRACES
from btq_lang.checks.engines import is_for_version_4
from btq_lang.checks.entries import EntryMention, handling
from btq_lang.checks.entries import mentions as mentions_in
from btq_lang.checks.flow import calls_of
from btq_lang.checks.pointers import pointed_at
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Pair, Tree, Word, port_named, quote
from btq_lang.util.record import replace
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def meant_entry(view: View) -> Iterator[Diagnostic]:
    """A value that is probably meant as an entry of its tree."""
    names: frozenset[str] | None = None
    for resolved, pair, value in view.seen.values():
        text = value.text
        if "$(" in text and (replaced := _of_launch(view, resolved, pair, value)) is not None:
            yield replaced
            continue
        if text.isidentifier():
            if is_own_value(text):
                continue
            names = _names(view) if names is None else names
            if text not in names:
                continue
        elif text[:1] not in _SIGNS and text[-1:] != "}":
            continue
        if (
            (is_pointer(text) and text[1:-1].isidentifier())
            or not is_port_name(pair.key.text)
            or resolved.is_placeholder
        ):
            continue
        port = port_of(view, resolved, pair.key.text)
        if port is not None and (port.content != "value" or _is_literal_for_output(view, port, text)):
            continue
        if port is not None and not resolved.is_subtree and check_literal(port.literal or port.type, text, view.target):
            continue  # an invalid literal, or one whose end is dropped
        meant = _bare_entry(view, resolved, pair, value) if text.isidentifier() else entry_in(view, value)
        if meant is not None:
            yield _diagnostic(value, meant)
        elif port is not None and text.isidentifier() and _is_bare_among_texts(view, resolved, pair, value, port):
            yield _ambiguous(value)


def _of_launch(view: View, seen: ResolvedNode, pair: Pair, value: Word) -> Diagnostic | None:
    """A substitution of launch files, which nothing replaces in a tree: `$(var planner)`."""
    launch = _LAUNCH.search(value.text) if not value.text.endswith(".xml") else None  # else nav2/ reports it
    port = port_of(view, seen, pair.key.text)
    is_text = port is not None and port.content != "value"
    if launch is None or is_text or seen.is_placeholder or not is_port_name(pair.key.text):
        return None
    if port is not None and check_literal(port.literal or port.type, value.text, view.target):
        return None  # an invalid literal
    message = f"`{launch[0]}` is a text here: only launch files have such substitutions"
    notes = ("write the value itself, or an entry that the robot's program sets: `{key}`",)
    return Diagnostic("misspelt-entry", value.span, message, notes=notes)


def with_entries(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The parser's diagnostics of an item, with the entry that a value like `[goal]` means."""
    words = {value.span: value for _, _, value in view.seen.values() if not value.quoted and "{" not in value.raw}
    for diagnostic in reported:
        meant = entry_in(view, words[diagnostic.span]) if diagnostic.span in words else None
        message = f"a blackboard entry is written `{meant}`"
        yield (
            replace(diagnostic, message=message, fixes=(write_fix(meant, diagnostic.span),))
            if meant is not None
            else diagnostic
        )


def entry_of(view: View, value: Word) -> str | None:
    """The entry of the tree that a value names, in its braces: bare, or in other signs."""
    if value.text.isidentifier():
        return f"{{{value.text}}}" if not is_own_value(value.text) and value.text in _names(view) else None
    return entry_in(view, value)


def entry_in(view: View, value: Word) -> str | None:
    """The entry that a value is probably meant to be, in its braces; None for a bare word and anything else."""
    text = value.text
    if OLD_ENTRY.fullmatch(text):
        return None  # which has a rule of its own
    if (half := _HALF.fullmatch(text)) is not None:
        return f"{{{half[1] or half[2]}}}"
    if (outside := _SIGN_OUTSIDE.fullmatch(text)) is not None:
        return f"{{@{outside[1]}}}"
    if (decorated := _DECORATED.fullmatch(text)) is None:
        return None
    name = next(filter(None, decorated.groups()))
    sign = "@" if text.lstrip("{ ")[:1] == "@" else ""
    meant = f"{{{sign}{name}}}"
    if is_pointer(text) and any(mention.creates and not mention.reads for mention in _mentions_of(view, text[1:-1])):
        return None  # something writes an entry of this very name
    return meant if meant != text and name in _names(view) else None


def _diagnostic(value: Word, meant: str) -> Diagnostic:
    text = value.text
    what = "braces" if text[1:2] == "{" else "blanks"
    message = f"the {what} inside `{text}` belong to the name of the entry; did you mean `{meant}`?"
    if not is_pointer(text):
        message = f"`{text}` is a text here, not the entry; did you mean `{meant}`?"
    elif what == "blanks" and text.replace(" ", "") != meant:
        message = f"`{text}` is an entry of that name, not a member of `{meant}`"
        notes = ("an entry is passed whole: let a node write the member to an entry of its own",)
        return Diagnostic("misspelt-entry", value.span, message, notes=notes)
    fix = replace_fix(f"Replace `{text}` with `{meant}`", value.span, meant)
    return Diagnostic("misspelt-entry", value.span, message, fixes=(fix,))


def _ambiguous(value: Word) -> Diagnostic:
    """A bare word that is either."""
    text, entry = quote(value.text), f"{{{value.text}}}"
    message = f"`{value.raw}` is a text here, not the entry `{entry}`"
    notes = (f"write `{entry}` for the entry, `{text}` for the text",)
    fixes = tuple(replace_fix(f"Write `{meant}`", value.span, meant) for meant in (entry, text))
    return Diagnostic("misspelt-entry", value.span, message, notes=notes, fixes=fixes, severity=Severity.HINT)


def _is_literal_for_output(view: View, port: PortKind, text: str) -> bool:
    """Whether another rule reports the value, as one for an output."""
    return port.direction == "output" and not is_pointer(text) and OUTPUT_IN_BRACES.holds(view.target)


def _bare_entry(view: View, resolved: ResolvedNode, pair: Pair, value: Word) -> str | None:
    """The entry that a bare word is probably meant to be."""
    name, key = value.text, pair.key.text
    port = port_of(view, resolved, key)
    if _FOR_NAMES.search(key) or (port is not None and port.direction == "output") or name not in _names(view):
        return None
    if resolved.is_subtree:
        is_certain = not view.is_xml or view.ask(is_for_version_4)  # version 3 passes the entry
    elif port is not None and port.type and plain_type(port.type) not in _TEXTS:
        is_certain = name != port.default
    else:
        is_certain = view.ask(_is_likely, view.facts, name, key)
    return f"{{{name}}}" if is_certain else None


def _is_bare_among_texts(view: View, resolved: ResolvedNode, pair: Pair, value: Word, port: PortKind) -> bool:
    """Whether a word without quotes names an entry that is set before, at a port for texts, where all other texts of
    the tree have quotes."""
    if view.is_xml or value.quoted or resolved.kind is not None or port.default == value.text:
        return False
    if plain_type(port.type) not in _TEXTS or port.direction != "input" or _FOR_NAMES.search(pair.key.text):
        return False
    is_declared = isinstance(view.item, Tree) and port_named(view.item.ports, value.text) is not None
    writers = (mention for mention in _mentions_of(view, value.text) if mention.creates and not mention.reads)
    if not is_declared and all(mention.span.start > value.start for mention in writers):
        return False
    return not any(_is_same_text_or_bare(view, other, value.text) for _, _, other in view.seen.values())


def _is_same_text_or_bare(view: View, value: Word, text: str) -> bool:
    """Whether a value is this text in quotes, or another word without quotes that can only be a text."""
    if value.quoted:
        return value.text == text
    return value.text.isidentifier() and not is_own_value(value.text) and value.text not in _names(view)


@of_scope
def _is_likely(store: Store[Workspace], viewpoint: str, tree: Facts, name: str, key: str) -> bool:
    """Whether a port that takes any text is likely meant to be given an entry of a tree."""
    view = View(store, viewpoint, tree)
    is_likely = name == key or name.endswith(f"_{key}") or _is_passed_so(view, name, key) or _is_lost(view, name)
    return is_likely and not _is_own_name(view, name)


def _is_passed_so(view: View, name: str, key: str) -> bool:
    """Whether a port of the same name is given the entry elsewhere in the tree."""
    return any(pair.key.text == key and pointed_at(key, value.text) == name for _, pair, value in view.seen.values())


def _is_lost(view: View, name: str) -> bool:
    """Whether the tree writes the entry, and nothing in it reads that."""
    mentions = _mentions_of(view, name)
    return bool(mentions) and all(mention.creates and not mention.reads for mention in mentions)


def _is_own_name(view: View, name: str) -> bool:
    """Whether the tree also gives a built-in node the name as a text: the value of the entry is its name."""
    texts = [(resolved.kind, pair.key.text) for resolved, pair, value in view.seen.values() if value.text == name]
    ports = [kind.port(key) for kind, key in texts if kind is not None]
    return any(port is not None and port.content == "value" for port in ports)


def _mentions_of(view: View, name: str) -> list[EntryMention]:
    return [mention for mention in view.ask(mentions_in, view.path, view.facts) if mention.name == name]


def _names(view: View) -> frozenset[str]:
    """The entries of the tree."""
    if view.tree_name is not None:
        return view.ask(_entries_of, view.tree_name.text)
    return frozenset(mention.name.removeprefix("@") for mention in view.ask(mentions_in, view.path, view.facts))


@on_circle(frozenset())
@of_scope
def _entries_of(store: Store[Workspace], viewpoint: str, tree: str) -> frozenset[str]:
    """The names of entries that a tree uses, declares or gets from the trees that run it, without their `@`."""
    view = View(store, viewpoint)
    own = view.ask(handling, tree)
    names = {*own.ports, *(touch.name for touch in own.touches)}
    for caller, call in calls_of(view, tree):
        names |= {*call.given, *call.values}
        if call.shares:
            names |= view.ask(_entries_of, caller)
    return frozenset(name.removeprefix("@") for name in names)


_WORD: Final = r"[^\W\d]\w*"
_NAME: Final = f"({_WORD})"
# Source: the substitutions of launch_xml, launch_ros and roslaunch; others look like commands of a shell.
_LAUNCH: Final = re.compile(r"\$\((?:var|arg|env|optenv|anon|find|find-pkg-share|find-pkg-prefix) +\w[\w.-]*\)")
_HALF: Final = re.compile(rf"\{{(@?{_WORD})|(@?{_WORD})\}}")
_SIGN_OUTSIDE: Final = re.compile(rf"@\{{{_NAME}\}}")
_DECORATED: Final = re.compile(
    rf"\$\(?{_NAME}\)?|\[{_NAME}\]|<{_NAME}>|%{_NAME}%|@{_NAME}|\{{\{{@?{_NAME}\}}\}}|\{{ *@? *{_NAME} *\}}"
    rf"|\{{@?{_NAME}(?:(?:\.|->|::)\w+|\[\w*\])+\}}"
)
_SIGNS: Final = frozenset("{$@[<%")
_FOR_NAMES: Final = re.compile("key|entry|variable|name|field|value$", re.IGNORECASE)
_TEXTS: Final = frozenset(("std::string", "std::string_view", "BT::StringView", "BT::Any", "BT::AnyTypeAllowed"))
