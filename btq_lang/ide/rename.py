"""Renaming: in every file, or not at all, with the reason.

One invariant: after a rename every word that meant the thing still does, and no other word does; where that is
impossible, nothing is renamed.  It is proved on the texts themselves, those on the disk, after the edits.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.btcpp.exact_edits import respelt
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.opening import with_source
from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import instance_name_problem, is_port_name, model_name_problem
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.catalog.nodes import lookup
from btq_lang.catalog.qualities import fold
from btq_lang.ide.meaning import ENGINE, STANDARD, ReferenceAt, Subject, at, definition, everywhere, subject
from btq_lang.syntax.tree import is_name, quote
from btq_lang.util.record import Record
from btq_lang.util.text import Edit, Span, apply_edits
from btq_lang.workspace.file import File
from btq_lang.workspace.references import KIND_OF, Mention, What
from btq_lang.workspace.workspace import Workspace


class Renamable(Record):
    """A name that can be changed: its place and its text."""

    span: Span
    name: str


class RenameRefusal(Record):
    """The reason why something cannot be renamed, as a sentence."""

    reason: str


class Renaming(Record):
    """The edits of a rename, by file; they count in the files on the disk, which may be XML."""

    edits: dict[str, tuple[Edit, ...]]


def prepare_rename(workspace: Workspace, path: str, offset: int) -> Renamable | RenameRefusal:
    """Whether the word at a place can be renamed."""
    reference = at(workspace, path, offset)
    if reference is None:
        return RenameRefusal("nothing to rename here")
    referent = subject(workspace, reference)
    reason = _refusal(workspace, referent, reference)
    return RenameRefusal(reason) if reason else Renamable(reference.span, reference.mention.name)


def rename(workspace: Workspace, path: str, offset: int, name: str) -> Renaming | RenameRefusal:
    """The edits that rename what the word at a place means; the new name gets quotes where needed."""
    reference = at(workspace, path, offset)
    if reference is None:
        return RenameRefusal("nothing to rename here")
    referent = subject(workspace, reference)
    reason = (
        _refusal(workspace, referent, reference)
        or _unfit(referent, name)
        or _is_the_other(workspace, path, referent, name)
    )
    if reason:
        return RenameRefusal(reason)
    places = tuple(everywhere(workspace, referent))
    uneditable = next(
        ((place.path, why) for place in places if (why := _why_uneditable(workspace.files[place.path]))), None
    )
    if uneditable is not None:  # a node without a model is the same in unrelated files
        return RenameRefusal(
            f"cannot rename `{referent.name}`: {workspace.project.shown(uneditable[0])}, {uneditable[1]}, also uses it"
        )
    if not (name.isascii() and name.isidentifier()) and any(_is_in_script(place.mention) for place in places):
        return RenameRefusal("a name in a script may contain only the letters A to Z, digits and `_`")
    # In a tree that runs itself, an entry may be a port as well: `{=}` then stays as it is.
    pairs = [
        {id(place.mention.pair) for place in places if place.mention.what is what} for what in (What.PORT, What.KEY)
    ]
    both = pairs[0] & pairs[1]
    reasons: list[str] = []
    for in_quotes in (False, True):  # a word of the language is a name if it is quoted
        edits: dict[str, tuple[Edit, ...]] = {}
        for place in places:
            renaming = _edits(place, referent, name, in_quotes, both)
            edits[place.path] = (*edits.get(place.path, ()), *respelt(workspace.files[place.path], renaming))
        edits = {changed: tuple(sorted(changes, key=lambda edit: edit.span)) for changed, changes in edits.items()}
        reasons.append(_changes_meaning(workspace, path, reference, places, edits, name))
        if not reasons[-1]:
            return Renaming(edits)
        if referent.what in _PLAIN or referent.what is What.KEY:
            break
    return RenameRefusal(reasons[0])


def _why_uneditable(file: File) -> str:
    """Why a file cannot be edited; empty if it can: missions and XML can."""
    if not file.is_foreign:
        return "" if file.is_btq else "which is not a .btq file"
    if is_generated(file.source):
        return "which a build wrote"
    if file.is_cpp:
        return "which is C++"
    return "" if file.is_understood else "which cannot be read"


def _refusal(workspace: Workspace, referent: Subject, reference: ReferenceAt) -> str:
    """Why a subject cannot be renamed; empty if it can."""
    mention = reference.mention
    if referent.what in _FIXED:
        return f"cannot rename {_FIXED[referent.what]}"
    if referent.home == STANDARD:
        return f"cannot rename `{referent.name}`: the quality model defines it"
    if referent.home.startswith(ENGINE):
        return f"cannot rename `{referent.name}`: the engine defines it"
    place, shown = definition(workspace, reference.path, referent), workspace.project.shown
    where = place.path if place is not None else referent.home.rpartition(":")[0]  # a port is in the model of its node
    if where in PACKAGED.values():
        return f"cannot rename `{referent.name}`: Nav2 defines it"
    if where in workspace.files and (why := _why_uneditable(workspace.files[where])):
        return f"cannot rename `{referent.name}`: its definition is in {shown(where)}, {why}"
    if place is not None and not referent.home:
        reason = f"its definition is in {shown(place.path)}, which this file does not include"
        return f"cannot rename `{referent.name}`: {reason}"
    if place is None and referent.what in KIND_OF and referent.what is not What.NODE:
        return f"cannot rename `{referent.name}`: it is not defined"
    if referent.what is What.KEY and mention.node is not None and mention.node.attribute("_autoremap") is not None:
        return "cannot rename: `_autoremap` passes every entry under its own name"
    for path in workspace.scope(reference.path).paths:
        if (why := _why_uneditable(workspace.files[path])) and referent.name in workspace.files[path].source:
            return f"cannot rename `{referent.name}`: {shown(path)}, {why}, may also use it"
    return ""


def _unfit(referent: Subject, name: str) -> str:
    """Why a name is not allowed for such a thing; empty if it is."""
    if not name.strip() or "\n" in name or "\r" in name:
        return "a name needs at least one character, on one line"
    if referent.what in _PLAIN and not is_name(name):
        return f"the name of a {referent.what.value} may contain only letters, digits and `_`"
    if referent.what is What.KEY and any(character in "{}\"'@= \t" for character in name):
        return "the name of an entry must not contain braces, quotes, spaces, `@` or `=`"
    if referent.what is What.PORT and (not is_port_name(name) or name in RESERVED_ATTRIBUTES):
        return f"the engine refuses the port name `{name}`"
    if referent.what in (What.TREE, What.NODE):
        if lookup(name) is not None:
            return f"`{name}` is a built-in node"
        problem = model_name_problem(name)
        return f"the engine refuses the name: {problem}" if problem else ""
    if referent.what is What.INSTANCE and (problem := instance_name_problem(name)):
        return f"the engine refuses the name: {problem}"
    return ""


def _is_the_other(workspace: Workspace, path: str, referent: Subject, name: str) -> str:
    """Why a signal cannot have the name of a context, a requirement that of a hazard, or the other way round; empty if
    it can."""
    other = _SHARING_NAMES.get(referent.what)
    taken = workspace.scope(path).find(other, name) if other is not None else None
    if taken is None or other is None:
        return ""
    line = workspace.files[taken.path].lines.position(taken.span.start).line + 1
    return f"`{name}` is already a {other.value}: {workspace.project.shown(taken.path)}, line {line}"


def _is_in_script(mention: Mention) -> bool:
    """Whether it is an entry's name in a script, neither a value by itself nor in braces."""
    text = mention.word.text
    return mention.what is What.KEY and text != mention.name and not text.startswith("{")


def _edits(place: ReferenceAt, referent: Subject, name: str, in_quotes: bool, both: set[int]) -> Iterator[Edit]:
    mention = place.mention
    start = place.entry.start if place.entry else 0
    if mention.what is What.KEY and not (mention.defines or mention.word.raw == referent.name):
        is_same = mention.pair is not None and mention.word.raw[mention.span.start - mention.word.start :][:1] == "="
        if not (is_same and mention.pair is not None and (mention.pair.key.text == name or id(mention.pair) in both)):
            yield Edit(place.span, name)
        return
    quoted = in_quotes or mention.word.quoted or not is_name(name)
    yield Edit(mention.word.span.shifted(start), quote(name) if quoted else name)
    pair = mention.pair
    value = pair.value if pair is not None else None
    is_same = value is not None and value.text.strip("{} ") == "="
    if mention.what is What.PORT and value is not None and is_same and id(pair) not in both:
        # `{=}` is the entry named as the port was: the entry keeps its name.
        yield Edit(value.span.shifted(start), f"{{{referent.name}}}")


def _changes_meaning(
    workspace: Workspace,
    path: str,
    reference: ReferenceAt,
    places: tuple[ReferenceAt, ...],
    edits: dict[str, tuple[Edit, ...]],
    name: str,
) -> str:
    """Why the texts after the edits have another meaning; empty if they do not."""
    after = workspace
    for changed, file_edits in edits.items():
        after = with_source(after, changed, apply_edits(workspace.files[changed].source, file_edits))
        if why := _why_uneditable(after.files[changed]):
            return f"`{name}` cannot be written in {workspace.project.shown(changed)}, {why} then"
    moved = after.files[path].from_disk(_after(_start(workspace, reference), edits[path]))
    renamed = at(after, path, moved) if moved is not None else None
    if renamed is None or not _is_called(renamed.mention, name):
        return f"`{name}` would have another meaning here"
    meaning = subject(after, renamed)
    expected = {(one.path, _after(_start(workspace, one), edits[one.path])) for one in places}
    reached = {(one.path, _start(after, one)) for one in everywhere(after, meaning)}
    for taken, start in sorted(reached - expected):
        line = after.files[taken].source_lines.position(start).line + 1
        return f"`{name}` is already in use: {taken}, line {line}"
    if expected - reached:
        return f"`{name}` would have another meaning in another place"
    return ""


def _start(workspace: Workspace, reference: ReferenceAt) -> int:
    """Where a reference begins in its file on the disk."""
    return workspace.files[reference.path].on_disk(reference.span).start


def _is_called(mention: Mention, name: str) -> bool:
    return mention.name == name or (mention.what is What.QUALITY and fold(mention.name).endswith(fold(name)))


def _after(offset: int, edits: tuple[Edit, ...]) -> int:
    """The position of an offset after some edits."""
    moved = offset
    for edit in edits:
        if edit.span.end <= offset:
            moved += len(edit.text) - (edit.span.end - edit.span.start)
    return moved


_FIXED = {
    What.ATTRIBUTE: "an attribute of the engine",
    What.QUANTITY: "a quantity",
    What.UNIT: "a unit",
    What.EDITION: "an edition",
    What.RULE: "a rule",
    What.INCLUDE: "a file here: rename it in its folder",
}
_SHARING_NAMES = {
    What.SIGNAL: Kind.CONTEXT,
    What.CONTEXT: Kind.SIGNAL,
    What.REQUIREMENT: Kind.HAZARD,
    What.HAZARD: Kind.REQUIREMENT,
}
_PLAIN = frozenset((What.SIGNAL, What.CONTEXT, What.PARAMETER))
