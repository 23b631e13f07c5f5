"""What completion proposes, kind by kind: names of the file's scope and of the project, words of the language,
qualities and units; node_proposals.py has nodes and their ports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.catalog.language import beginning
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.catalog.qualities import EDITIONS
from btq_lang.catalog.qualities import find as find_quality
from btq_lang.catalog.qualities import parts as quality_parts
from btq_lang.catalog.qualities import qualities as standard_qualities
from btq_lang.catalog.units import dimension_name, parse_unit, symbols
from btq_lang.catalog.verbs import VERBS
from btq_lang.diagnostics.rules import RULES
from btq_lang.ide.meaning import ReferenceAt, is_main, match_of, subject
from btq_lang.ide.measures import MeasuredValue, parameters_at
from btq_lang.ide.moves import include_name
from btq_lang.ide.outline import requirement_detail
from btq_lang.ide.place import CursorPlace, word_text
from btq_lang.requirements.nodes import nodes as nodes_in_scope
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import (
    Context,
    Entry,
    Hazard,
    QualityDecl,
    Requirement,
    Signal,
    Tree,
    is_name,
    quote,
    shape,
    written,
)
from btq_lang.util.record import Record, replace
from btq_lang.workspace.file import Definition
from btq_lang.workspace.references import Mention, What
from btq_lang.workspace.workspace import Workspace


class Proposal(Record):
    """A word that may follow at a place.

    Attributes:
        kind: keyword, node, tree, requirement, hazard, external, quality, signal, context, parameter, port, attribute,
            key, unit, file, rule, tag, instance, enum or snippet.
        detail: shown beside it in the list.
        insert: the text to insert; `snippet`: the same as a snippet of LSP.
        filter: the text that the typed letters are compared with, if not the label.
        name: the key for `documentation`; empty if there is none.
        include: the file to include for it, if it is out of scope.
    """

    label: str
    kind: str
    detail: str = ""
    insert: str = ""
    snippet: str | None = None
    filter: str = ""
    name: str = ""
    include: str = ""


def words(texts: Iterable[str], kind: str) -> Iterator[Proposal]:
    """Words of the language; the cursor goes into the quotes, brackets and braces in them."""
    for word in texts:
        offset = next((word.index(pair) + 1 for pair in ('""', "()", "{}") if pair in word), None)
        snippet = f"{escaped(word[:offset])}$0{escaped(word[offset:])}" if offset is not None else None
        yield Proposal(word, kind, "", word, snippet)


def keyword(label: str, snippet: str | None = None) -> Proposal:
    """Words of the language that begin something."""
    phrase = beginning(label)
    return Proposal(label, "keyword", phrase.brief, label, snippet, "", phrase.words)


def quoted(text: str) -> str:
    """A word in quotes, unless it has them already."""
    return text if text.startswith(('"', "'")) else quote(text)


def escaped(text: str) -> str:
    """Text escaped for a snippet."""
    return text.replace("\\", "\\\\").replace("$", "\\$").replace("}", "\\}")


# ---- items and clauses ----


def item_words(workspace: Workspace, path: str) -> Iterator[Proposal]:
    has_root = "Root" in workspace.files[path].text
    for word, snippet in _ITEMS:
        if not (word == "Root" and has_root):
            yield keyword(word, snippet)


def category_words() -> Iterator[Proposal]:
    for word in sorted(CATEGORIES):
        yield keyword(word, f"{word} ${{1:Name}}\n    $0")


def node_clause_words() -> Iterator[Proposal]:
    yield from (keyword(word) for word in ("satisfies", "satisfices", "tags"))


def port_heads() -> Iterator[Proposal]:
    for word in ("input", "output", "inout"):
        yield keyword(word, f'{word} ${{1:name}} : ${{2:string}} "$0"')


def port_words(place: CursorPlace) -> Iterator[Proposal]:
    if place.last == ":":
        yield from types()


def types() -> Iterator[Proposal]:
    yield from words(_TYPES, "enum")


def clauses(present: tuple[str, ...]) -> Iterator[Proposal]:
    """Verbs and heads of clauses, in the order in which a requirement is written; those that may occur once and do are
    left out."""
    for word, snippet in _CLAUSES:
        head, *following = word.split()[:2]
        if head not in _ONCE or not {head, *following}.issubset(present):
            yield keyword(word, snippet)


# ---- names ----


def requirements(workspace: Workspace, path: str) -> Iterator[Proposal]:
    """Requirements of every file, those in scope first; one out of scope comes with its include."""
    for definition, include in defined(workspace, path, Kind.REQUIREMENT):
        item = definition.symbol.target
        text = requirement_detail(item) if isinstance(item, Requirement) else ""
        parameters = item.parameters if isinstance(item, Requirement) else ()
        name = written(definition.symbol.name)
        needed = [one.name.text for one in parameters if one.default is None]
        fill = ", ".join(f"{key} = ${{{index}:{key}}}" for index, key in enumerate(needed, 1))
        snippet = f"{escaped(name)}({fill})" if needed else None
        yield Proposal(definition.symbol.name, "requirement", text, name, snippet, "", definition.symbol.name, include)


def requirement_ids(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    """Requirements that another can refine: all but the one that is being written."""
    own = [word_text(word) for word in (*place.parent, *place.words)]
    for one in requirements(workspace, path):
        if one.label not in own:
            yield replace(one, snippet=None)


def hazards(workspace: Workspace, path: str) -> Iterator[Proposal]:
    for definition, include in defined(workspace, path, Kind.HAZARD):
        item, name = definition.symbol.target, definition.symbol.name
        text = " ".join(item.text.text.split()) if isinstance(item, Hazard) and item.text is not None else ""
        yield Proposal(name, "hazard", text, written(name), None, "", name, include)


def external_ids(workspace: Workspace, place: CursorPlace) -> Iterator[Proposal]:
    """The requirements of other tools, without those that the clause has."""
    imported = workspace.project.external_requirements
    written_names = [word_text(word) for word in place.words]
    for one in imported.by_id.values() if imported is not None else ():
        if one.id not in written_names:
            yield Proposal(one.id, "external", one.title, written(one.id), None, "", one.id)


def undeclared(workspace: Workspace, path: str, kind: Kind, what: What) -> Iterator[Proposal]:
    """The names that the file or a linked one refers to and that no file declares yet."""
    names: set[str] = set()
    for other in workspace.linked(path):
        file = workspace.files[other]
        if what is not What.VALUE and all(
            workspace.files_defining(used_kind, name) for used_kind, name in file.used_names if used_kind is kind
        ):
            continue
        for entry in file.parsed.entries:
            named = (one for one in file.mentions_of(entry) if one.what is what and not one.defines)
            names.update(one.name for one in named if not subject(workspace, ReferenceAt(other, entry, one)).home)
    for name in sorted(names):
        if is_name(name) and not workspace.defined_anywhere(kind, name):
            yield Proposal(name, kind.value, "not declared yet", name)


def signals(workspace: Workspace, path: str) -> Iterator[Proposal]:
    for definition, include in defined(workspace, path, Kind.SIGNAL):
        item, name = definition.symbol.target, definition.symbol.name
        unit = item.unit.text if isinstance(item, Signal) and item.unit else ""
        yield Proposal(name, "signal", unit, name, None, "", name, include)


def _contexts(workspace: Workspace, path: str) -> Iterator[Proposal]:
    for definition, include in defined(workspace, path, Kind.CONTEXT):
        item, name = definition.symbol.target, definition.symbol.name
        shown = ""
        if isinstance(item, Context) and item.condition is not None:
            shown = workspace.files[definition.path].on_one_line(definition.entry, item.condition)
        yield Proposal(name, "context", shown, name, None, "", name, include)


def operands(
    workspace: Workspace, path: str, place: CursorPlace, measured: MeasuredValue, contexts: bool = True
) -> Iterator[Proposal]:
    """Operands of a comparison: the requirement's parameters, contexts, signals; those that measure what is wanted come
    first and, if that is certain, alone."""
    named = parameters_at(place)
    proposals = [Proposal(name, "parameter", "parameter", name) for name in named]
    proposals += _contexts(workspace, path) if contexts else ()
    proposals += signals(workspace, path)
    fits = [measured.fits(named.get(one.label, one.detail)) for one in proposals]
    yield from (one for one, fit in zip(proposals, fits, strict=True) if fit)
    if not measured.is_certain:
        yield from (one for one, fit in zip(proposals, fits, strict=True) if not fit)


def parameters(workspace: Workspace, path: str, requirement: str) -> Iterator[Proposal]:
    """The parameters of a requirement, as arguments."""
    item = workspace.scope(path).target(Kind.REQUIREMENT, requirement)
    for parameter in item.parameters if isinstance(item, Requirement) else ():
        unit = parameter.unit.text if parameter.unit is not None else ""
        name = parameter.name.text
        yield Proposal(name, "parameter", unit, f"{name} = ", f"{name} = ${{0:1 {unit}}}")


def tags(workspace: Workspace, path: str) -> Iterator[Proposal]:
    paths = [other for other, file in workspace.files.items() if "tag" in file.text]
    for name in sorted({mention.name for mention in _mentioned(workspace, paths, What.TAG)}):
        yield Proposal(name, "tag", "", written(name))


def node_names(workspace: Workspace, path: str) -> Iterator[Proposal]:
    """Trees, nodes and instance names that a path can name."""
    scope = workspace.scope(path)
    for name in scope.names(Kind.TREE):
        yield Proposal(name, "tree", "tree", written(name), None, "", name)
    seen: set[str] = set()
    for mention in _mentioned(workspace, scope.paths, What.INSTANCE, What.NODE):
        if mention.name in seen or (mention.what is What.NODE and lookup(mention.name, mention.word.quoted)):
            continue
        seen.add(mention.name)
        kind = "instance" if mention.what is What.INSTANCE else "node"
        detail = mention.node.head.text if mention.what is What.INSTANCE and mention.node is not None else ""
        yield Proposal(
            mention.name, kind, detail, written(mention.name), None, "", mention.name if kind == "node" else ""
        )


def kinds(workspace: Workspace, path: str) -> Iterator[Proposal]:
    """What may follow `every`: kinds of nodes, even if only declared; a tree whose name is one."""
    nodes = workspace.store.ask(nodes_in_scope, path)
    names = [one for one in node_names(workspace, path) if one.kind == "node" or nodes.every(one.label)]
    yield from (one for one in names if one.kind != "tree")
    used = {node.kind.tag: node.kind for node in nodes.all if node.kind is not None}
    for tag in sorted(used):
        yield Proposal(tag, "node", used[tag].doc, tag, None, "", tag)
    yield from (one for one in names if one.kind == "tree")


def keys(workspace: Workspace, path: str, entry: Entry, root: bool) -> Iterator[Proposal]:
    """The entries of a tree's blackboard, and with `@` those of the root's; without an item, only the root's."""
    of_root = _keys_of_root(workspace, path)
    if root or not isinstance(entry.item, Tree):
        yield from (Proposal(name, "key", "root blackboard", name) for name in of_root)
        return
    seen: dict[str, Proposal] = {}
    for port in entry.item.ports:
        if port.name is not None:
            type_ = f" : {port.type.text}" if port.type else ""
            seen[port.name.text] = Proposal(port.name.text, "key", f"{port.direction.raw}{type_}", port.name.text)
    for mention in workspace.files[path].mentions_of(entry):
        if mention.what is What.KEY and not mention.root and mention.name and is_name(mention.name):
            detail = mention.node.head.text if mention.node is not None else ""
            seen.setdefault(mention.name, Proposal(mention.name, "key", detail, mention.name))
    yield from seen.values()
    own = seen if is_main(workspace, path, entry) else {}  # they are the root's too
    yield from (Proposal(f"@{name}", "key", "root blackboard", f"@{name}") for name in of_root if name not in own)


def _keys_of_root(workspace: Workspace, path: str) -> list[str]:
    names: set[str] = set()
    for other in workspace.scope(path).paths:
        for entry in workspace.files[other].parsed.entries:
            of_main = is_main(workspace, other, entry)
            mentions = workspace.files[other].mentions_of(entry)
            names.update(one.name for one in mentions if one.what is What.KEY and (one.root or of_main))
    return sorted(names)


def includes(workspace: Workspace, path: str, quoted: bool) -> Iterator[Proposal]:
    """The project's other files, as an include names them."""
    for other in sorted(workspace.files):
        if other == path:
            continue
        name = include_name(workspace, path, other)
        if workspace.included(path, name) == other:
            yield Proposal(name, "file", "", quote(name) if quoted else name)


# ---- knowledge ----


def qualities(workspace: Workspace, path: str, place: CursorPlace) -> Iterator[Proposal]:
    """Qualities: custom ones, then characteristics, then their parts; after `performance-efficiency.`, its parts alone.

    A part is found by its own name and by its characteristic's.  Some editors compare the typed letters with the start
    of the filter text alone, so the name that begins with these letters comes first in it.
    """
    chosen = EDITIONS[workspace.edition(path)]
    if place.last == ".":
        whole = find_quality((word_text(place.group[-2]),), chosen).quality if len(place.group) > 1 else None
        for standard in quality_parts(whole.id, chosen) if whole else ():
            part = standard.id.rpartition(".")[2]
            names = dict.fromkeys((part, part.replace("behaviour", "behavior"), standard.name))
            yield Proposal(part, "quality", standard.name, part, None, " ".join(names), standard.id)
        return
    for definition, include in defined(workspace, path, Kind.QUALITY):
        item = definition.symbol.target
        text = item.text.text if isinstance(item, QualityDecl) and item.text else ""
        name = definition.symbol.name
        yield Proposal(name, "quality", text, written(name), None, "", name, include)
    for standard in sorted(standard_qualities(chosen), key=lambda quality: "." in quality.id):
        part = standard.id.rpartition(".")[2]
        names = dict.fromkeys((standard.id, part, standard.id.replace("behaviour", "behavior"), standard.name))
        typed = place.prefix.lower()
        both = " ".join(sorted(names, key=lambda name: not name.lower().startswith(typed)))
        yield Proposal(standard.id, "quality", standard.name, standard.id, None, both, standard.id)
        yield from _short_names(part, workspace.edition(path))


def _short_names(part: str, chosen: str) -> Iterator[Proposal]:
    """The names of qualities that another name begins with: `performance`, `time`."""
    words = part.split("-")
    for count in range(1, len(words)):
        name = "-".join(words[:count])
        if (quality := match_of(name, chosen).quality) is not None:
            yield Proposal(name, "quality", quality.name, name, None, "", quality.id)


def units(measured: MeasuredValue) -> Iterator[Proposal]:
    """Units; those that measure what is wanted come first, beginning with the one that is spelt the same; if that is
    certain, they come alone."""
    compounds = dict.fromkeys((*_COMPOUNDS, measured.unit or "1"))
    candidates = [*symbols(), *(unit for text in compounds if text != "1" and (unit := parse_unit(text)) is not None)]
    candidates = list({unit.symbol: unit for unit in candidates}.values())
    fitting = {unit.symbol for unit in candidates if measured.fits(unit.symbol)}
    candidates.sort(key=lambda unit: (unit.symbol not in fitting, unit.symbol != measured.unit))
    for unit in candidates:
        if unit.symbol in fitting or not measured.is_certain:
            yield Proposal(unit.symbol, "unit", dimension_name(unit), unit.symbol)


def units_of_names() -> Iterator[Proposal]:
    """What may follow the `:` of a signal or a parameter."""
    yield from units(MeasuredValue())
    yield from words(("bool", "text", "1"), "unit")


def rules() -> Iterator[Proposal]:
    for rule in RULES.values():
        yield Proposal(rule.name, "rule", rule.summary, rule.name, None, "", rule.name)


# ---- parts of the above ----


def defined(workspace: Workspace, path: str, kind: Kind) -> Iterator[tuple[Definition, str]]:
    """Every definition of a kind: those in scope, then those of other files with the file to include, unless including
    it duplicates a definition or makes a circle."""
    scope = workspace.scope(path)
    for name in scope.names(kind):
        if (definition := scope.find(kind, name)) is not None:
            yield definition, ""
    seen = set(scope.names(kind))
    for other in sorted(workspace.files.keys() - scope.paths):
        names = workspace.files[other].names_of(kind)
        if seen.issuperset(names):
            continue
        new = set(names) - seen
        if not _clashes(workspace, path, other):
            seen |= new
            definitions = (one for one in workspace.files[other].defined if one.symbol.kind is kind)
            yield from ((one, other) for one in definitions if one.symbol.name in new)


def _clashes(workspace: Workspace, path: str, other: str) -> bool:
    """Whether a file, or one that it includes, redefines what is in scope, or includes this file."""
    scope = workspace.scope(path)
    closure = workspace.closure(other)
    names_in_scope = [workspace.files[each].defined_names for each in scope.paths]
    return path in closure or any(
        not _is_same_model(workspace, path, file, *name)
        for file in closure
        if file not in scope.paths
        for names in names_in_scope
        for name in names & workspace.files[file].defined_names
    )


def _is_same_model(workspace: Workspace, path: str, other: str, kind: Kind, name: str) -> bool:
    """Whether two files declare a node with the same ports."""
    first = shape(workspace.scope(path).target(kind, name))
    others = workspace.files[other].definitions(kind, name)
    return kind is Kind.MODEL and all(first == shape(one.symbol.target) for one in others)


def _mentioned(workspace: Workspace, paths: Iterable[str], *kinds: What) -> Iterator[Mention]:
    """The references of some kinds, in the order of the text."""
    for path in paths:
        file = workspace.files[path]
        for entry in file.parsed.entries:
            yield from [one for one in file.mentions_of(entry) if one.what in kinds]


def unknown(workspace: Workspace, paths: Iterable[str]) -> list[str]:
    """The custom nodes in use."""
    used = frozenset().union(*[workspace.files[path].kinds for path in paths])
    return sorted({name for name, quoted in used if name and lookup(name, quoted) is None})


_TYPES = (
    *("string", "bool", "int", "double", "float", "int64_t", "uint64_t", "std::vector<double>", "std::vector<string>"),
)
_COMPOUNDS = ("m/s", "m/s^2", "rad/s", "deg/s", "1/s", "%/h", "kB/s")
_ITEMS = (
    ("BehaviorTree", "BehaviorTree ${1:Name}\n    ->$0"),
    ("QualityReq", 'QualityReq ${1:id} : ${2:quality} "${3:text}"\n    $0'),
    ("include", 'include "$0"'),
    ("Root", "Root ${0:Main}"),
    ("signal", "signal ${1:name} : ${2:unit} from {${0:key}\\}"),
    ("context", "context ${1:name} : $0"),
    ("apply", "apply ${1:requirement} to $0"),
    ("hazard", 'hazard ${1:H1} "$0"'),
    ("scenario", 'scenario "${1:What happens}" of ${2:Main}\n    given $3\n    expect ${0:mission succeeds}'),
    ("given", "given $0"),
    ("quality", 'quality ${1:name} : ${2:parent} "$0"'),
    ("qualities", "qualities ${0:iso25010-2023}"),
    ("Action", "Action ${1:Name}\n    $0"),
    ("Condition", "Condition ${0:Name}"),
    ("Decorator", "Decorator ${1:Name}\n    $0"),
    ("Control", "Control ${1:Name}\n    $0"),
    ("SubTree", "SubTree ${1:Name}\n    $0"),
    ("TreeNodesModel", "TreeNodesModel\n    $0"),
)
_ONCE = frozenset(("in", "with", "confidence", "over", "on", "goal", "because", "verified", "priority"))
_CLAUSES = (
    *(form for verb in VERBS.values() for form in verb.forms or ((verb.word, None),) if form[0]),
    ("mission", None),
    ("every", None),
    ("from", "from ${1:A} starts to ${2:B} succeeds $0"),
    ("sum of", None),
    ("while", None),
    ("when", None),
    ("assuming", None),
    ("on average", None),
    ("in at least", "in at least ${1:95 %} of ${0:runs}"),
    ("with probability", "with probability >= ${1:95 %} of ${0:runs}"),
    ("confidence", "confidence ${0:95 %}"),
    ("over last", "over last ${1:100} ${0:runs}"),
    ("on violation", "on violation ${0:fail}"),
    ("goal", "goal ${0:10 s}"),
    ("because", 'because "$0"'),
    ("verified by", "verified by ${0:test}"),
    ("source", 'source "$0"'),
    ("refines", None),
    ("mitigates", None),
    ("priority", "priority ${0:high}"),
    ("approved by", None),
)
