"""What a word under the cursor means in its file.

One invariant: two references mean the same if and only if their subjects are equal, in whatever files they are.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from functools import lru_cache

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup, spellings
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, find, fold
from btq_lang.ide.ports import builtin_named
from btq_lang.syntax.tokens import COMMENT, NAME
from btq_lang.syntax.tree import Entry, Model, QualityPath, Requirement, Root, Satisfices, Tree, Word
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.file import Definition
from btq_lang.workspace.node_names import meaning_of
from btq_lang.workspace.references import KIND_OF, Mention, What, called
from btq_lang.workspace.workspace import Workspace

ENGINE = "engine"
STANDARD = "standard"
ROOT_BLACKBOARD = "@"


class Subject(Record):
    """What a reference names.

    Attributes:
        name: the tag of a built-in node, the id of a standard quality, the path of a file.
        home: what distinguishes it from others of its name: where it is defined; empty if it is defined nowhere, or if
            its name alone identifies it.
    """

    what: What
    name: str
    home: str = ""


class ReferenceAt(Record):
    """A reference in a file; `entry`: around it, None in a comment."""

    path: str
    entry: Entry | None
    mention: Mention

    @property
    def span(self) -> Span:
        """The name, counted from the start of the file."""
        return self.mention.span.shifted(self.entry.start if self.entry else 0)


def at(workspace: Workspace, path: str, offset: int) -> ReferenceAt | None:
    """The reference that an offset is in, or that ends there.

    Raises:
        KeyError: the file does not exist.
    """
    entry = entry_at(workspace, path, offset)
    touching = []
    if entry is not None:
        inside = offset - entry.start
        for mention in workspace.files[path].mentions_of(entry):
            if mention.span.start <= inside <= mention.span.end:
                touching.append(mention)
    if touching:  # of two that touch, like `{a}` and the word after it, the one that begins here
        best = min(touching, key=lambda mention: (mention.span.end == inside, -mention.span.start))
        return ReferenceAt(path, entry, best)
    return _rule_at(workspace, path, offset)


def entry_at(workspace: Workspace, path: str, offset: int) -> Entry | None:
    """The last item that begins at an offset or before it."""
    entries = workspace.files[path].parsed.entries
    index = bisect_right(entries, offset, key=lambda entry: entry.start + entry.item.start)
    return entries[index - 1] if index else None


def subject(workspace: Workspace, reference: ReferenceAt) -> Subject:
    """What a reference means."""
    path, entry, mention = reference.path, reference.entry, reference.mention
    if mention.what in (What.RULE, What.EDITION, What.TAG, What.QUANTITY, What.UNIT, What.ATTRIBUTE) or entry is None:
        return Subject(mention.what, mention.name)
    if mention.what is What.INCLUDE:
        return Subject(What.INCLUDE, workspace.included(path, mention.name) or mention.name)
    if mention.what is What.QUALITY:
        return _quality(workspace, path, mention)
    if mention.what is What.NODE:
        return _node(workspace, path, mention)
    if mention.what in KIND_OF:
        return _defined(workspace, path, mention.what, mention.name)
    if mention.what is What.PARAMETER:
        owner = mention.owner
        name = owner.name.text if isinstance(owner, Requirement) and owner.name else owner
        home = _defined(workspace, path, What.REQUIREMENT, name).home if isinstance(name, str) else ""
        return Subject(What.PARAMETER, mention.name, home or f"{path}:{entry.start}")
    if mention.what is What.VALUE:
        return _value(workspace, path, entry, mention)
    if mention.what is What.PLACE:
        return _place(workspace, path, mention.name)
    if mention.what is What.PORT:
        return _port(workspace, reference)
    if mention.what is What.KEY:
        if isinstance(mention.owner, str) and (tree := workspace.find(path, Kind.TREE, mention.owner)) is not None:
            return Subject(What.KEY, mention.name, _blackboard(workspace, tree.path, tree.entry, mention.root))
        return Subject(What.KEY, mention.name, _blackboard(workspace, path, entry, mention.root))
    return Subject(mention.what, mention.name, f"{path}:{entry.start}")


def definition(workspace: Workspace, path: str, referent: Subject) -> Definition | None:
    """The definition of a subject in the symbols of a file's scope, or else anywhere in the project."""
    kind = KIND_OF.get(referent.what)
    if kind is None or referent.home in (ENGINE, STANDARD):
        return None
    in_scope = workspace.find(path, kind, referent.name)
    if in_scope is not None and home_of(in_scope) == referent.home:
        return in_scope
    anywhere = workspace.defined_anywhere(kind, referent.name)
    return next((one for one in anywhere if not referent.home or home_of(one) == referent.home), None)


def home_of(place: Definition) -> str:
    """The home of a definition, as in its subject."""
    return f"{place.path}:{place.span.start}"


def everywhere(workspace: Workspace, referent: Subject, paths: tuple[str, ...] | None = None) -> Iterator[ReferenceAt]:
    """Every reference to a subject in some files, or in all, file by file, in the order of their texts."""
    words = _spellings(referent)
    for path in paths if paths is not None else _paths(workspace, referent):
        file = workspace.files[path]
        if words and not any(word in file.text for word in words):
            continue  # that is known without parsing it
        if words:
            references = [ReferenceAt(path, *mentioned) for word in words for mentioned in file.mentioned(word)]
            if len(words) > 1:
                references.sort(key=lambda reference: reference.span)
        else:
            references = [
                ReferenceAt(path, entry, mention)
                for entry in file.parsed.entries
                for mention in file.mentions_of(entry)
                if _may_mean(referent, mention)
            ]
        yield from (reference for reference in references if subject(workspace, reference) == referent)


def _paths(workspace: Workspace, referent: Subject) -> list[str]:
    """The files that may name a subject: those linked with its home and XML with a pool, or all if it has none."""
    home = referent.home.removeprefix(ROOT_BLACKBOARD).rpartition(":")[0] or referent.home.removeprefix(ROOT_BLACKBOARD)
    if home not in workspace.files:
        return sorted(workspace.files)
    return sorted({*workspace.linked(home), *(workspace.foreign if workspace.project.pools else ())})


def _spellings(referent: Subject) -> tuple[str, ...]:
    """All words by which a subject can be named; empty if they cannot be listed."""
    if referent.what is What.NODE and referent.home == ENGINE:
        kind = lookup(referent.name, quoted=True)
        return spellings(kind) if kind is not None else ()
    if referent.what in (What.QUALITY, What.INCLUDE) or _ESCAPED.search(referent.name):
        return ()
    return (referent.name,)


def _may_mean(referent: Subject, mention: Mention) -> bool:
    """Whether a reference may mean a subject that has many spellings."""
    if referent.what not in (What.QUALITY, What.INCLUDE):
        return mention.name == referent.name
    if mention.what is not referent.what or referent.what is What.INCLUDE or referent.home == STANDARD:
        return mention.what is referent.what
    return fold(mention.name.rpartition(".")[2]) == fold(referent.name)


def quality_of(requirement: Definition) -> QualityPath | None:
    """The quality of a requirement: its own, or in the classic form the enclosing one."""
    item, owner = requirement.symbol.target, requirement.entry.item
    if not isinstance(item, Requirement) or item.quality is not None or not isinstance(owner, Tree):
        return item.quality if isinstance(item, Requirement) else None
    for clause in (*owner.clauses, *(clause for node in owner.walk() for clause in node.clauses)):
        for quality in clause.qualities if isinstance(clause, Satisfices) else ():
            if any(one is item for one in quality.requirements):
                return quality.path
    return None


def quality_match(workspace: Workspace, path: str, name: str) -> QualityMatch:
    """The match of a quality name in the standard."""
    return match_of(name, workspace.edition(path))


@lru_cache(2_000)  # colouring looks up each quality of a file, and a misspelt one is compared with all names
def match_of(name: str, edition: str) -> QualityMatch:
    """As `quality_match`, in an edition."""
    return find(tuple(name.split(".")), EDITIONS[edition])


# ---- kinds of subjects ----


def _defined(workspace: Workspace, path: str, what: What, name: str) -> Subject:
    place = workspace.find(path, KIND_OF[what], name)
    return Subject(what, name, home_of(place) if place else "")


def _node(workspace: Workspace, path: str, mention: Mention) -> Subject:
    if (tree := _modelled_tree(workspace, path, mention)) is not None:
        return Subject(What.TREE, mention.name, home_of(tree))
    node = mention.node
    is_kind = node is not None and node.kind is not None and mention.word == node.kind
    quoted = mention.word.quoted
    if is_kind or (mention.defines and not quoted):
        builtin = builtin_named(workspace, path, mention.name, quoted, len(node.nodes) if node else None)
        if builtin is not None:
            return Subject(What.NODE, builtin.tag, ENGINE)
    return _defined(workspace, path, What.NODE, mention.name)


def _modelled_tree(workspace: Workspace, path: str, mention: Mention) -> Definition | None:
    """The tree whose model has a name or a port, if it is that of a tree: its ports are entries of the tree."""
    model = mention.owner
    if not isinstance(model, Model) or model.category.raw != "SubTree" or model.name is None:
        return None
    return workspace.find(path, Kind.TREE, model.name.text)


def _quality(workspace: Workspace, path: str, mention: Mention) -> Subject:
    own = own_quality(workspace, path, mention.name.rpartition(".")[2])
    if own is not None:
        return Subject(What.QUALITY, own.symbol.name, home_of(own))
    match = quality_match(workspace, path, mention.name)
    if match.quality is not None:
        return Subject(What.QUALITY, match.quality.id, STANDARD)
    return Subject(What.QUALITY, mention.name)


def own_quality(workspace: Workspace, path: str, name: str) -> Definition | None:
    """The declaration of a custom quality, compared as names of qualities are."""
    scope = workspace.scope(path)
    folded = fold(name)
    for own in scope.names(Kind.QUALITY):
        if fold(own) == folded:
            return scope.find(Kind.QUALITY, own)
    return None


def _value(workspace: Workspace, path: str, entry: Entry, mention: Mention) -> Subject:
    owner = mention.owner
    if isinstance(owner, Requirement) and any(mention.name == one.name.text for one in owner.parameters):
        home = _defined(workspace, path, What.REQUIREMENT, owner.name.text).home if owner.name else ""
        return Subject(What.PARAMETER, mention.name, home or f"{path}:{entry.start}")
    for what in (What.CONTEXT, What.SIGNAL):
        declared = _defined(workspace, path, what, mention.name)
        if declared.home:
            return declared
    place = _place(workspace, path, mention.name)
    return place if place.home else Subject(What.SIGNAL, mention.name)


def _place(workspace: Workspace, path: str, name: str) -> Subject:
    builtin = builtin_named(workspace, path, name)
    if builtin is not None:
        return Subject(What.NODE, builtin.tag, ENGINE)
    for what in (What.NODE, What.TREE):
        declared = _defined(workspace, path, what, name)
        if declared.home:
            return declared
    label = ""
    for other in workspace.scope(path).paths:
        file = workspace.files[other]
        for entry, mention in file.mentioned(name) if name in file.text else ():
            if mention.what is What.NODE:
                return Subject(What.NODE, name)
            if mention.what is What.INSTANCE:
                label = label or f"{other}:{entry.start}"
    return Subject(What.INSTANCE, name, label) if label else Subject(What.NODE, name)


def _port(workspace: Workspace, reference: ReferenceAt) -> Subject:
    mention = reference.mention
    if mention.defines:
        if (tree := _modelled_tree(workspace, reference.path, mention)) is not None:
            return Subject(What.KEY, mention.name, _blackboard(workspace, tree.path, tree.entry, False))
        name = mention.owner.name if isinstance(mention.owner, Model) else None
        model = _defined(workspace, reference.path, What.NODE, name.text if name else "")
        return Subject(What.PORT, mention.name, model.home or reference.path)
    node = mention.node
    if node is None:  # in a scenario
        return _port_named(workspace, reference, str(mention.owner))
    name = called(node)
    if name is not None:
        tree = workspace.find(reference.path, Kind.TREE, name.text)
        if tree is not None:
            return Subject(What.KEY, mention.name, _blackboard(workspace, tree.path, tree.entry, False))
        return Subject(What.PORT, mention.name, f"tree {name.text}")
    if node.id is None:
        return Subject(What.PORT, mention.name)
    kind = meaning_of(node, lambda name: workspace.store.ask(inputs.declared, reference.path, name)).kind
    if kind is not None:
        return Subject(What.PORT, mention.name, f"{ENGINE} {kind.tag}")
    owner = _defined(workspace, reference.path, What.NODE, node.id.text)
    return Subject(What.PORT, mention.name, owner.home or f"node {node.id.text}")


def _port_named(workspace: Workspace, reference: ReferenceAt, name: str) -> Subject:
    """The port of the node that a scenario names; if it has no such port, an entry."""
    path, port = reference.path, reference.mention.name
    kind = builtin_named(workspace, path, name)
    if kind is not None:
        return Subject(What.PORT, port, f"{ENGINE} {kind.tag}")
    node_id = id_meant(workspace, path, name)
    model = workspace.scope(path).target(Kind.MODEL, node_id)
    if isinstance(model, Model) and all(each.id is None or each.id.text != port for each in model.ports):
        return Subject(What.KEY, port, f"{ROOT_BLACKBOARD}{workspace.missions[path]}")
    return Subject(What.PORT, port, _defined(workspace, path, What.NODE, node_id).home or f"node {node_id}")


def id_meant(workspace: Workspace, path: str, name: str) -> str:
    """The ID of a node with an ID or an instance name."""
    if _place(workspace, path, name).what is not What.INSTANCE:
        return name
    ids = {
        mention.node.id.text
        for other in workspace.scope(path).paths
        for _, mention in workspace.files[other].mentioned(name)
        if mention.what is What.INSTANCE and mention.node is not None and mention.node.id is not None
    }
    return min(ids, default=name)


def _blackboard(workspace: Workspace, path: str, entry: Entry, root: bool) -> str:
    """The blackboard that a key belongs to: each tree has one, and the main tree's is the root's; files that include
    each other run together."""
    if root or is_main(workspace, path, entry):
        return f"{ROOT_BLACKBOARD}{workspace.missions[path]}"
    return f"{path}:{entry.start}"


def is_main(workspace: Workspace, path: str, entry: Entry) -> bool:
    """Whether a tree is a mission: its file's main tree, in a file that is not merely included."""
    main = workspace.main_tree(path)
    if main is None or main.path != path or main.entry is not entry:
        return False
    return bool(workspace.files[path].of_type(Root)) or path not in workspace.included_files


def _rule_at(workspace: Workspace, path: str, offset: int) -> ReferenceAt | None:
    """The name of a rule in `# btq: ignore[rule, …]`."""
    file = workspace.files[path]
    if not file.has_directives:
        return None
    for token in file.parsed.tokens:
        if token.kind == COMMENT and token.start <= offset <= token.end:
            listed = _IGNORED.search(token.text)
            for name in _RULE_NAME.finditer(listed[1]) if listed else ():
                span = Span(*name.span()).shifted(token.start + (listed.start(1) if listed else 0))
                if span.start <= offset <= span.end:
                    return ReferenceAt(path, None, Mention(What.RULE, name[0], span, Word(NAME, span.start, name[0])))
    return None


_ESCAPED = re.compile(r"[\"'\\\r\n\t]")
_IGNORED = re.compile(r"btq:\s*ignore\s*\[([^\]]*)")
_RULE_NAME = re.compile(r"[\w-]+")
