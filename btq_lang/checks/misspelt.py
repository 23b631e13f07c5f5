"""Blackboard entries whose name is misspelt.

Every name is an entry to the engine, and the robot's program may read and write any, so an unused name proves nothing.
A name is reported if it occurs in one place only, it has no effect there, and another name in scope differs from it
only as a misspelling would.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from functools import lru_cache

from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.calls import callers
from btq_lang.checks.entries import EntryMention, blackboards
from btq_lang.checks.entries import mentions as mentions_in
from btq_lang.checks.strings import in_source, moved
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Tree, Verbatim
from btq_lang.util.record import replace
from btq_lang.util.spelling import distance, without_digits
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


def misspelt_entry(view: View) -> Iterator[Diagnostic]:
    """Entries that are named once, only read or only written, and almost spelt like another entry; also `True` and
    unquoted texts in scripts.
    """
    tree = view.item
    mentions = view.ask(mentions_in, view.path, view.facts)
    if not isinstance(tree, Tree) or tree.name is None or not mentions:
        return
    if any(isinstance(child, Verbatim) for node in view.nodes for child in node.node.children):
        return  # unchecked XML may name any entry
    yield from _misspelt_booleans(mentions, view, tree.name.text)
    counts = Counter(mention.name for mention in mentions)
    if min(counts.values()) > 1:
        return
    names = dict.fromkeys((*counts, *(port.name.text for port in tree.ports if port.name is not None)))
    if (outside := view.ask(lookups.outside_entries)) and not view.ask(callers, tree.name.text):
        names |= dict.fromkeys(name for name, _ in outside)
    names_set_in_cpp = view.ask(cpp_lookups.set_in_cpp).names
    if names_set_in_cpp and not view.ask(callers, tree.name.text):
        names |= dict.fromkeys(sorted(names_set_in_cpp))
    if any(mention.name[:1] == "@" for mention in mentions):
        names |= dict.fromkeys(f"@{name}" for name in sorted(view.ask(_root_names) | names_set_in_cpp))
    deletion_index = _deletion_index(names)
    reported: set[str] = set()
    for mention in mentions:
        if counts[mention.name] > 1:
            continue
        for meant in _alike(mention.name, deletion_index):
            if meant in reported or _occur_together(mentions, mention, meant):
                continue
            if view.ask(_is_meant, tree.name.text, mention.name, meant, meant in counts) and view.ask(
                inputs.is_complete
            ):
                reported.add(mention.name)
                yield _diagnostic(mentions, mention, meant, counts.get(meant) == 1)
                break
    unreported_in_scripts = [
        mention
        for mention in mentions
        if mention.in_script and counts[mention.name] == 1 and mention.name not in reported
    ]
    if unreported_in_scripts:
        yield from _unquoted_texts(unreported_in_scripts, view, tree.name.text)


def _misspelt_booleans(mentions: Iterable[EntryMention], view: View, tree: str) -> Iterator[Diagnostic]:
    """`True` in a script, where it is the name of an entry."""
    for mention in mentions:
        meant = mention.name.lower()
        if not mention.in_script or mention.name == meant or meant not in ("true", "false"):
            continue
        if not view.ask(_is_created, tree, mention.name) and view.ask(inputs.is_complete):
            message = f"a script reads `{mention.name}` as the name of an entry; did you mean `{meant}`?"
            fix = write_fix(meant, mention.span)
            yield Diagnostic("misspelt-entry", mention.span, message, fixes=(fix,))


def _unquoted_texts(mentions: Iterable[EntryMention], view: View, tree: str) -> Iterator[Diagnostic]:
    """`msg := hello`, `state == idle`: an entry that nothing sets, where a text may be meant."""
    from btq_lang.syntax.script.tree import operands  # most files have no script, and it is large

    for mention in mentions:
        name = mention.name
        if not mention.reads or not _may_be_text(name) or not view.ask(inputs.is_complete):
            continue
        pair = next(attribute for attribute in mention.node.node.attributes if attribute.span.contains(mention.span))
        value = pair.value
        spans = (
            [Span(operand.start, operand.end) for operand in operands(view.script(value.text))]
            if value is not None
            else []
        )
        span = next((part for part in spans if value is not None and in_source(value, part) == mention.span), None)
        if value is None or span is None or view.ask(_is_set, tree, name):
            continue
        message = f"a script reads `{name}` as an entry, which nothing here sets"
        fix = replace_fix(f"Write the text `'{name}'`", span, f"'{name}'")
        diagnostic = Diagnostic("misspelt-entry", span, message, severity=Severity.HINT, fixes=(fix,))
        yield replace(moved(diagnostic, value), notes=(f"a text goes in single quotes: `'{name}'`",))


def _may_be_text(name: str) -> bool:
    """Whether a name may be a text whose quotes are missing; one in capitals is taken for an enumeration constant."""
    return name[:1] != "@" and not name.isupper() and name.lower() not in ("true", "false")


def _occur_together(mentions: Iterable[EntryMention], mention: EntryMention, other: str) -> bool:
    """Whether the same node uses the other entry in a port, or writes both; then they are two different entries."""
    other = other.removeprefix("@")
    return any(
        another.node is mention.node
        and another.name.removeprefix("@") == other
        and (not another.in_script or (another.writes and mention.writes))
        for another in mentions
    )


def _root_names(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """The names of the root blackboard that the trees in scope mention."""
    return frozenset(store.ask(blackboards, viewpoint).root_names)


def _is_created(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    return any(touch.creates for touch in store.ask(blackboards, viewpoint).uses_of(tree, name))


def _is_set(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether anything creates an entry, or it comes from outside."""
    return store.ask(blackboards, viewpoint).is_given(tree, name) or _is_created(store, viewpoint, tree, name)


def _is_meant(store: Store[Workspace], viewpoint: str, tree: str, name: str, meant: str, is_mentioned: bool) -> bool:
    """Whether the use of one entry has no effect, and would have one for another entry.

    Args:
        is_mentioned: whether the tree mentions `meant` outside its port declarations.
    """
    boards = store.ask(blackboards, viewpoint)
    if boards.is_given(tree, name) or boards.is_one(tree, name, meant):
        return False
    place = boards.place(tree, name)
    if not place[0] and boards.root_names.get(place[1], 0) > 1:
        return False
    uses, other_uses = boards.uses_of(tree, name), boards.uses_of(tree, meant)
    is_port = boards.is_port(tree, meant)
    names_set_in_cpp = store.ask(cpp_lookups.set_in_cpp, viewpoint).names
    if name.removeprefix("@") in names_set_in_cpp:
        return False
    if not any(use.writes for use in uses):  # read only
        root, entry = boards.place(tree, meant)
        return is_port or any(use.writes for use in other_uses) or (not root and entry in names_set_in_cpp)
    if _is_without_vowels(name, meant):
        return False
    if not any(use.reads for use in uses):  # written only
        # the only use of the other name is a read, which gets its own diagnostic
        reported_at_read = len(other_uses) == 1 and not other_uses[0].writes
        return is_port or (any(use.reads for use in other_uses) and not reported_at_read)
    return len(uses) == 1 and (is_port or is_mentioned)


def _diagnostic(mentions: Iterable[EntryMention], mention: EntryMention, meant: str, is_single: bool) -> Diagnostic:
    """The diagnostic for an entry that is meant as another one.

    Args:
        is_single: whether the other name also occurs once, so that it may be the misspelt one.
    """
    name = mention.name
    other = next((candidate for candidate in mentions if candidate.name == meant), None)
    message = f"`{name}` appears only here; did you mean `{meant}`?"
    if not mention.writes and mention.reads:
        message = f"nothing writes `{name}`, which is read here; did you mean `{meant}`?"
    elif not mention.reads and mention.writes:
        message = f"nothing reads `{name}`, which is written here; did you mean `{meant}`?"
    fixes = [_renaming(mention, meant)]
    if is_single and other is not None:
        fixes.append(_renaming(other, name))
    related = (Related(Place(other.span), f"`{meant}`"),) if other is not None else ()
    return Diagnostic("misspelt-entry", mention.span, message, related=related, fixes=tuple(fixes))


def _renaming(mention: EntryMention, name: str) -> Fix:
    # otherwise the source is `{=}`, short for the port's own name
    is_bare = len(mention.name) == mention.span.end - mention.span.start
    return replace_fix(f"Replace `{mention.name}` with `{name}`", mention.span, name if is_bare else f"{{{name}}}")


def _deletion_index(names: Iterable[str]) -> dict[str, list[str]]:
    """An index to find similar names without comparing all pairs: if two names are one edit apart, deleting at most one
    letter from each makes them equal.
    """
    index: dict[str, list[str]] = {}
    for name in names:
        for variant in _deletions(name):
            index.setdefault(variant, []).append(name)
    return index


def _alike(name: str, deletion_index: dict[str, list[str]]) -> list[str]:
    """The names of which `name` may be a misspelling, the most similar first."""
    candidates = {
        other for variant in _deletions(name) for other in deletion_index.get(variant, ()) if _is_slip(name, other)
    }
    return sorted(candidates - {name}, key=lambda other: (distance(name, other), other))


@lru_cache(1_000)  # the same names are in tree after tree
def _is_slip(word: str, meant: str) -> bool:
    """Whether two names are too similar to be meant for two things: `traget`, `batteryLevel`, `imgg`.

    Names that differ in a digit, in a plural ending or, if they are short, in one letter at an end are different
    things: `goal1` and `goal2`, `goal` and `goals`, `goal` and `goal_x`.
    """
    if any((word[:1] == sign) != (meant[:1] == sign) for sign in "@_"):
        return False  # only one of them is on the root blackboard (`@`) or private (`_`): not a misspelling
    word, meant = word.removeprefix("@"), meant.removeprefix("@")
    folded, other = _folded(word), _folded(meant)
    if folded == other or _is_without_vowels(folded, other):
        return len(folded) > 2
    if without_digits(folded) == without_digits(other):
        return False
    short, long = sorted((folded, other), key=len)
    if len(long) < 4 or long in (f"{short}s", f"{short}es") or distance(folded, other) > 1:
        return False
    if len(short) < len(long):
        index = next((i for i in range(len(short)) if short[i] != long[i]), len(short))
        is_doubled = long[index] in (long[index - 1 : index] + long[index + 1 : index + 2])
        at_an_end = index in (0, len(long) - 1)
        return is_doubled or (len(long) > 5 if not at_an_end else len(long) > 7)
    if sorted(short) == sorted(long):
        return True
    pieces = zip(word.split("_"), meant.split("_"), strict=False)
    return any(one != two and min(len(one), len(two)) > 5 for one, two in pieces)


@lru_cache(1_000)
def _deletions(name: str) -> frozenset[str]:
    name = _folded(name)
    return frozenset((name, _without_vowels(name), *(name[:index] + name[index + 1 :] for index in range(len(name)))))


def _is_without_vowels(word: str, meant: str) -> bool:
    """Whether a word is another one without its vowels: `cnt` for `count`."""
    return len(word) > 2 and word != meant and word == _without_vowels(meant)


def _folded(name: str) -> str:
    return name.removeprefix("@").replace("_", "").casefold()


def _without_vowels(name: str) -> str:
    return "".join(letter for letter in name if letter not in "aeiou")
