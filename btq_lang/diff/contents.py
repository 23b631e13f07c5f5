"""The contents of a mission, whatever its spelling: its nodes and named items in a form that can be compared.

One invariant: two spellings of one thing give one form: `->` and `Sequence`, `Timeout (msec = 30 s)` and the `30000` of
an XML file, a requirement defined at a node and one defined at file level, a classic placeholder and its skill.
Comments, layout and the order of attributes, ports and clauses are no part of it.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator
from typing import Final, TypeAlias

from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.qualities import EDITIONS, find
from btq_lang.catalog.units import convert, parse_unit, to_si
from btq_lang.lexer import tokens
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.scan import number_end
from btq_lang.syntax.tokens import BLANK, COMMENT, NUMBER, QUANTITY
from btq_lang.util.record import Record
from btq_lang.util.text import Placed, Span
from btq_lang.workspace.file import File
from btq_lang.workspace.node_names import is_placeholder, tag_of
from btq_lang.workspace.symbols import requirements_at
from btq_lang.workspace.workspace import Workspace

SUBTREE: Final = "SubTree"
TREE: Final = "<tree>"  # no node has such a kind
VERBATIM: Final = "<xml>"
MAIN: Final = "main tree"
MISSION: Final = "mission"


class DiskPlace(Record):
    """A place: a file, and a span of its text on the disk."""

    path: str
    span: Span


class AspectValue(Record):
    """The value of one aspect."""

    key: object
    text: str


Values: TypeAlias = dict[str, AspectValue]


class TreePart:
    """A node, or a tree above its nodes.

    Attributes:
        kind: the XML tag: a built-in's, a custom node's ID, `SubTree`, `BehaviorTree`; `xml` of verbatim XML.
        target: the tree that a SubTree calls.
        name: the instance name, or the ID of a tree.
        word: the kind as it is written.
        category: `Action`, `Condition`, … if it is written.
        values: all else, by aspect: `station`, `quality safety`, `requirement rq1`, `tag heavy`.
        requirements: the IDs of the attached ones.
    """

    __slots__ = ("category", "children", "kind", "name", "place", "requirements", "target", "values", "word")

    def __init__(self, kind: str, word: str, place: DiskPlace) -> None:
        self.kind = kind
        self.word = word
        self.place: Final = place
        self.target: str | None = None
        self.name: str | None = None
        self.category: str | None = None
        self.values: Values = {}
        self.requirements: list[str] = []
        self.children: list[TreePart] = []


class Item(Record):
    """Something with a name beside the trees: a requirement, a signal, a model.

    Attributes:
        thing: `requirement`, `signal`, `context`, `quality`, `node model`, `include`, `apply`, `scenario`, `given`,
            `mission` or `xml`.
        name: its ID; without one, its text.
        values: by aspect: `takes`, `on violation`, `port station`.
    """

    thing: str
    name: str
    values: Values
    place: DiskPlace


def contents(workspace: Workspace, paths: Iterable[str]) -> tuple[list[TreePart], list[Item]]:
    """The trees of some files together, and all else in them; of duplicates the first counts, as in the language.

    Args:
        paths: the mission's own file is the last; the Roots of the others have no effect.
    """
    trees: list[TreePart] = []
    items: dict[tuple[str, str], Item] = {}
    paths = tuple(paths)
    for path in paths:
        reader = _Reader(workspace, workspace.files[path])
        for entry in workspace.files[path].parsed.entries:
            reader.entry = entry
            if isinstance(entry.item, syntax.Tree):
                trees.append(reader.tree(entry.item))
            else:
                for item in reader.items():
                    if path == paths[-1] or not isinstance(entry.item, syntax.Root):
                        items.setdefault((item.thing, item.name), item)
        for item in reader.inside:
            items.setdefault((item.thing, item.name), item)
    main = workspace.main_tree(paths[-1]) if paths else None
    if main is not None:  # if it is named in the Root, or is the only candidate
        values = items[MISSION, ""].values if (MISSION, "") in items else {}
        name = main.symbol.name
        place = DiskPlace(main.path, main.span)
        items[MISSION, ""] = Item(MISSION, "", {**values, MAIN: AspectValue(name, name)}, place)
    for tree in trees:
        model = items.get(("node model", tree.name or ""))
        if model is not None and model.values["category"].key == SUBTREE:  # XML has a tree's ports only there
            ports = {aspect: value for aspect, value in model.values.items() if aspect.startswith("port ")}
            tree.values = {**ports, **tree.values}
            del items[model.thing, model.name]
    return trees, [*items.values()]


class _Reader:
    """One file being read."""

    def __init__(self, workspace: Workspace, file: File) -> None:
        self.entry: syntax.Entry = syntax.Entry(0, syntax.Verbatim(0, 0, None), False)
        self.inside: list[Item] = []  # requirements that are defined at nodes
        self._file: Final = file
        self._edition: Final = EDITIONS[workspace.edition(file.path)]

    # ---- trees ----

    def tree(self, tree: syntax.Tree) -> TreePart:
        top = TreePart(TREE, "BehaviorTree", self._place(tree.start, tree.end))
        top.name = tree.name.text if tree.name is not None else None
        self._pairs(top, tree.attributes)
        self._clauses(top, tree.clauses)
        top.values.update(self._ports(tree.ports))
        waiting: list[tuple[TreePart, tuple[syntax.Node | syntax.Verbatim, ...]]] = [(top, tree.children)]
        while waiting:
            above, children = waiting.pop()
            for child in children:
                part = self._node(child) if isinstance(child, syntax.Node) else self._verbatim(child)
                above.children.append(part)
                if isinstance(child, syntax.Node) and child.children:
                    waiting.append((part, child.children))
        return top

    def _node(self, node: syntax.Node) -> TreePart:
        part = TreePart("", node.head.text, self._place(node.start, node.end))
        part.category = node.category.raw if node.category is not None else None
        part.name = node.name.text if node.name is not None else None
        if is_placeholder(node) and part.name is not None:
            part.kind = part.word = legal_name(part.name)
            part.name = part.name if part.name != part.kind else None
        elif part.category == SUBTREE:
            part.kind, part.target, part.category = SUBTREE, node.id.text if node.id is not None else "", None
        else:
            part.kind = tag_of(node)
        self._pairs(part, node.attributes, node.category is not None and node.kind is None)
        self._clauses(part, node.clauses)
        return part

    def _verbatim(self, verbatim: syntax.Verbatim) -> TreePart:
        part = TreePart(VERBATIM, "xml", self._place(verbatim.start, verbatim.end))
        part.values["element"] = _value(verbatim.text)
        return part

    def _pairs(self, part: TreePart, pairs: tuple[syntax.Pair, ...], has_id: bool = False) -> None:
        builtin = BUILTINS.get(part.kind)
        for pair in pairs:
            key = pair.key.text
            if key == "name" or (has_id and key == "ID") or key in part.values:  # the first value counts
                continue
            port = builtin.port(key) if builtin is not None else None
            part.values[key] = _value(pair.value, port.unit if port is not None else None)

    def _clauses(self, part: TreePart, clauses: tuple[syntax.NodeClause, ...]) -> None:
        for clause in clauses:
            if isinstance(clause, syntax.Tags):
                for tag in clause.names:
                    part.values[f"tag {tag.text}"] = AspectValue(True, "")
            if isinstance(clause, syntax.Satisfices):
                for quality in clause.qualities:
                    if not quality.requirements:
                        part.values[f"quality {self._quality(quality.path)}"] = AspectValue(True, "")
                    for requirement in quality.requirements:
                        self._attach(part, requirement, quality.path)
            else:
                for use in requirements_at((clause,)):
                    self._attach(part, use)

    def _attach(
        self, part: TreePart, requirement: syntax.Requirement | syntax.ReqRef, quality: syntax.QualityPath | None = None
    ) -> None:
        arguments: tuple[object, ...] = ()
        text = ""
        name = requirement.name.text if requirement.name is not None else ""
        if isinstance(requirement, syntax.ReqRef):
            arguments = tuple(
                sorted(((each.name.text, _meaning(each.value)) for each in requirement.arguments), key=repr)
            )
            text = ", ".join(f"{each.name.text} = {self._text(each.value)}" for each in requirement.arguments)
        elif not requirement.is_reference:
            self.inside.append(self._requirement(requirement, quality))
        part.values[f"requirement {name}"] = AspectValue(arguments, text)
        part.requirements.append(name)

    # ---- items ----

    def items(self) -> Iterator[Item]:
        """The things that an item other than a tree defines."""
        item = self.entry.item
        if isinstance(item, syntax.Requirement):
            yield self._requirement(item)
        elif isinstance(item, syntax.Model):
            yield self._model(item)
        elif isinstance(item, syntax.Models):
            for each in item.models:
                yield self._model(each) if isinstance(each, syntax.Model) else self._item("xml", each.text, {}, each)
        elif isinstance(item, syntax.Signal):
            words = {"unit": item.unit, "from": item.source, "kind": item.behaviour, "fresh within": item.fresh}
            values = {aspect: _value(word) for aspect, word in words.items() if word is not None}
            if item.fresh is not None:
                values["fresh within"] = AspectValue(_meaning(item.fresh), item.fresh.raw)
            if item.initially is not None:
                values["initially"] = AspectValue(_meaning(item.initially), self._text(item.initially))
            yield self._item("signal", item.name, values, item)
        elif isinstance(item, syntax.Context):
            condition = AspectValue(_meaning(item.condition), self._text(item.condition))
            yield self._item("context", item.name, {"condition": condition}, item)
        elif isinstance(item, syntax.QualityDecl):
            values = {"title": _value(item.text)} if item.text is not None else {}
            if item.parent is not None:
                values["below"] = self._quality_value(item.parent)
            yield self._item("quality", item.name, values, item)
        elif isinstance(item, syntax.Hazard):
            yield self._hazard(item)
        elif isinstance(item, syntax.Scenario):
            yield self._scenario(item)
        elif isinstance(item, syntax.Given):
            text = _spaced(self._slice(item.start, item.end))
            yield Item(
                "given",
                text.removeprefix("given "),
                {"": AspectValue(_meaning(item), text)},
                self._place(item.start, item.end),
            )
        elif isinstance(item, syntax.Include):
            values = {pair.key.text: _value(pair.value) for pair in item.attributes}
            path = posixpath.normpath(item.path.text) if item.path is not None else ""  # `./lib.btq` is the same file
            yield Item("include", path, values, self._place(item.start, item.end))
        elif isinstance(item, syntax.Root):
            values = {_MISSION_WORDS.get(pair.key.text, pair.key.text): _value(pair.value) for pair in item.attributes}
            if item.name is not None:
                values[MAIN] = _value(item.name)
            values.pop("BTCPP_format", None)  # which built files and XML have, and missions do not
            if values:
                yield Item(MISSION, "", values, self._place(item.start, item.end))
        elif isinstance(item, syntax.Qualities):
            yield Item(MISSION, "qualities", {"edition": _value(item.edition)}, self._place(item.start, item.end))
        elif isinstance(item, syntax.Apply):
            text = self._slice(item.start, item.end)
            yield Item("apply", text, {"": AspectValue(_meaning(item), text)}, self._place(item.start, item.end))
        elif isinstance(item, syntax.Verbatim):
            yield self._item("xml", item.text, {}, item)

    def _requirement(self, requirement: syntax.Requirement, quality: syntax.QualityPath | None = None) -> Item:
        values: Values = {}
        if requirement.text is not None:
            text = " ".join(requirement.text.text.split())
            values["title"] = AspectValue(text, f'"{text}"')
        quality = requirement.quality or quality
        if quality is not None:
            values["quality"] = self._qualities_value((quality, *requirement.further))
        for parameter in requirement.parameters:
            text = " : ".join(word.raw for word in (parameter.name, parameter.unit) if word is not None)
            default = f" = {self._text(parameter.default)}" if parameter.default is not None else ""
            values[f"parameter {parameter.name.text}"] = AspectValue(_meaning(parameter), text + default)
        for clause in requirement.clauses:
            aspect = clause.row if isinstance(clause, syntax.Claim) else _ASPECTS[type(clause)]
            if isinstance(clause, syntax.Odds) and clause.is_of_time:
                aspect = "share of time"
            aspect = numbered(aspect, values)
            values[aspect] = AspectValue(_meaning(clause), self._slice(clause.start, clause.end))
        return self._item("requirement", requirement.name, values, requirement)

    def _hazard(self, hazard: syntax.Hazard) -> Item:
        values = {"title": _value(hazard.text)} if hazard.text is not None else {}
        for clause in hazard.clauses:
            aspect = numbered(_ASPECTS[type(clause)], values)
            values[aspect] = AspectValue(_meaning(clause), self._slice(clause.start, clause.end))
        return self._item("hazard", hazard.name, values, hazard)

    def _scenario(self, scenario: syntax.Scenario) -> Item:
        values = {"of": _value(scenario.tree)} if scenario.tree is not None else {}
        for name in scenario.verifies:
            values[f"verifies {name.text}"] = AspectValue(True, "")
        for step in scenario.steps:
            text = _spaced(self._slice(step.start, step.end))
            values[numbered(text, values)] = AspectValue(_meaning(step), text)
        return self._item("scenario", scenario.title, values, scenario)

    def _model(self, model: syntax.Model) -> Item:
        values = {"category": _value(model.category), **self._ports(model.ports)}
        if model.text is not None:
            values["title"] = _value(model.text)
        for pair in model.attributes:
            values[pair.key.text] = _value(pair.value)
        for part in model.body:
            if isinstance(part, syntax.Meta):
                for pair in part.attributes:
                    values[f"metadata {pair.key.text}"] = _value(pair.value)
            elif isinstance(part, syntax.Verbatim):
                values[f"xml {part.text.text if part.text is not None else ''}"] = AspectValue(True, "")
        return self._item("node model", model.name, values, model)

    def _ports(self, ports: tuple[syntax.Port, ...]) -> Values:
        return {
            f"port {port.name.text if port.name is not None else ''}": AspectValue(
                (
                    *(port.direction.raw, _saying(port.type), _default(port), _saying(port.text)),
                    *sorted((pair.key.text, _saying(pair.value)) for pair in port.attributes),
                ),
                self._slice(port.start, port.end),
            )
            for port in ports
        }

    def _item(self, thing: str, name: syntax.Word | None, values: Values, part: Placed) -> Item:
        return Item(thing, name.text if name is not None else "", values, self._place(part.start, part.end))

    # ---- words and places ----

    def _quality(self, path: syntax.QualityPath) -> str:
        words = tuple(name.text for name in path.names)
        match = find(words, self._edition)
        return match.quality.id if match.quality is not None else path.text

    def _quality_value(self, path: syntax.QualityPath) -> AspectValue:
        return AspectValue(self._quality(path), path.text)

    def _qualities_value(self, paths: tuple[syntax.QualityPath, ...]) -> AspectValue:
        meaning = sorted(map(self._quality, paths))
        return AspectValue(meaning[0] if len(meaning) == 1 else (*meaning,), " and ".join(path.text for path in paths))

    def _text(self, part: object) -> str:
        """A part of the tree as it is written, on one line."""
        places = list(_places(part))
        return self._slice(min(start for start, _ in places), max(end for _, end in places)) if places else ""

    def _slice(self, start: int, end: int) -> str:
        text = self._file.text[start + self.entry.start : end + self.entry.start]
        if "#" in text or "/" in text:
            text = "".join(token.text if token.kind != COMMENT else " " for token in tokens(text))
        return " ".join(text.split())

    def _place(self, start: int, end: int) -> DiskPlace:
        span = Span(start, end).shifted(self.entry.start)
        return DiskPlace(self._file.path, self._file.on_disk(span))


def _places(part: object) -> Iterator[tuple[int, int]]:
    for word in syntax.walk(part):
        if isinstance(word, syntax.Word):
            yield word.start, word.end


def _meaning(part: object) -> object:
    """The structure of a part, in which `90 s` equals `1.5 min`."""
    return syntax.shape(part, _in_si)


def _in_si(word: syntax.Word) -> object:
    quantity = parse_quantity(word.raw)
    if quantity is None:
        return "".join(word.raw.split())
    return quantity[1].dimension, f"{to_si(quantity[0], quantity[1]):.12g}"


def _value(word: syntax.Word | None, unit: str | None = None) -> AspectValue:
    if word is None:
        return AspectValue(None, "")
    if word.kind == QUANTITY:
        quantity, wanted = parse_quantity(word.raw), parse_unit(unit) if unit is not None else None
        if quantity is not None and wanted is not None and quantity[1].dimension == wanted.dimension:
            return AspectValue(f"{convert(quantity[0], quantity[1], wanted):.15g}", word.raw)
        return AspectValue("".join(word.raw.split()), word.raw)
    return AspectValue(word.text, word.raw if "\n" not in word.raw else " ".join(word.raw.split()))


def numbered(aspect: str, values: Values) -> str:
    """The key of a further value of an aspect: `because #2`."""
    count = 1 + sum(key.split(" #")[0] == aspect for key in values)
    return aspect if count == 1 else f"{aspect} #{count}"


def _saying(word: syntax.Word | None) -> str:
    return word.text if word is not None else ""


def _default(port: syntax.Port) -> str:
    if port.default is not None and port.default.kind == NUMBER and _saying(port.type) in ("double", "float"):
        return f"{float(port.default.text):.15g}"  # a build writes 25.0 for 25
    return _saying(port.default)


def _spaced(text: str) -> str:
    """A step with the same blanks, however it is written."""
    words = [token for token in tokens(text) if token.kind < BLANK]
    written = " ".join(_of_quantity(token.text) if token.kind == QUANTITY else token.text for token in words)
    return _NO_BLANK.sub(lambda match: match[0].strip(), written).strip()


def _of_quantity(raw: str) -> str:
    end = number_end(raw, 0)
    return f"{raw[:end]} {raw[end:].strip()}"


_NO_BLANK: Final = re.compile(r"\( | (?=[,:)])| / ")
_MISSION_WORDS: Final = {"main_tree_to_execute": MAIN}
_ASPECTS: Final[dict[type, str]] = {
    syntax.ScopeClause: "scope",
    syntax.FromUntil: "from … until",
    syntax.Assuming: "assumption",
    syntax.Average: "on average",
    syntax.Odds: "odds",
    syntax.Confidence: "confidence",
    syntax.Window: "over last",
    syntax.OnViolation: "on violation",
    syntax.Goal: "goal",
    syntax.Because: "because",
    syntax.How: "verified by",
    syntax.Source: "source",
    syntax.Refines: "refines",
    syntax.Mitigates: "mitigates",
    syntax.Priority: "priority",
    syntax.Approval: "approved by",
    syntax.HazardSeverity: "severity",
}
