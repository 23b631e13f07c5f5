"""A file as XML that the engine loads (docs/language.md): the document, the repairs, and what cannot be written.

One invariant: it never raises for a file of the workspace; without a problem, the document is well-formed. It knows
neither the disk nor the enforcement of requirements; a later pass finds the elements to wrap in `Export.elements`.
"""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Mapping
from typing import Final, TypeAlias

from btq_lang.btcpp.attributes import attributes_of, only_first
from btq_lang.btcpp.document import Attribute, Content, Document, Element, escape
from btq_lang.btcpp.models import ModelCollector, model_element, suggested_model, undeclared
from btq_lang.btcpp.source import ExportSource, Remark
from btq_lang.btcpp.spelling import spelt
from btq_lang.btcpp.trees import Trees
from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Entry, Include, Model, Root, Tree, Verbatim
from btq_lang.syntax.tree import Models as ModelsItem
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import Record
from btq_lang.workspace.comments import NO_COMMENTS
from btq_lang.workspace.file import SUFFIXES, Definition
from btq_lang.workspace.workspace import Workspace

IncludedAs: TypeAlias = Callable[[str], str]


class Export(Record):
    """A file as XML.

    Attributes:
        repairs: what was changed because the engine would refuse it.
        problems: what cannot be written; the document then differs in meaning from the file.
        elements: the element of each node of the file, by `id(node)`.
        guessed: the undeclared nodes, with the category that their models state.
    """

    document: Document
    repairs: tuple[Remark, ...]
    problems: tuple[Remark, ...]
    elements: Mapping[int, Element]
    guessed: Mapping[str, str]


def export(
    workspace: Workspace,
    path: str,
    *,
    target: str | None = None,
    verbatim: bool = False,
    included_as: IncludedAs | None = None,
    is_bundled: bool = False,
) -> Export:
    """A file of a workspace as XML.

    Args:
        target: the version of the engine to write for; None: the project's.
        verbatim: write exactly what is in the file: no repairs and no additions.
        included_as: gives the path in an `<include>` for an included file's path in the workspace; None: that relative
            to this file, with `.xml` in place of `.btq`.
        is_bundled: whether included XML is written too.

    Raises:
        KeyError: there is no such file.
    """
    with NotCollecting():
        source = ExportSource(workspace, path, target or workspace.project.target, verbatim, is_bundled)
        trees = Trees(source)
        guessed: dict[str, str] = {}
        name = included_as or (lambda target: xml_path(workspace, path, target))
        document = _document(source, trees, name, guessed)
        source.finish()
        return Export(document, tuple(source.repairs), tuple(source.problems), trees.elements, guessed)


def xml_path(workspace: Workspace, path: str, included: str) -> str:
    """How the XML of the file `path` names that of an included file, if XML files are written beside their sources."""
    relative = posixpath.relpath(included, posixpath.dirname(path) or ".")
    return xml_name(relative) if is_mission(workspace, included) else relative


def is_mission(workspace: Workspace, path: str) -> bool:
    """Whether a file is written in this language, and not in XML."""
    return workspace.files[path].is_btq


def xml_name(path: str) -> str:
    """The name of the XML file that is made from a file."""
    return posixpath.splitext(path)[0] + ".xml"


def _document(source: ExportSource, trees: Trees, included_as: IncludedAs, guessed: dict[str, str]) -> Document:
    entries = source.file.parsed.entries
    before: list[Content] = []
    after: list[Content] = []
    root = Element("root")
    contents = root.children
    end_of_block: list[Content] = []  # comments at the end of the Root's block
    models = ModelCollector()
    head: Entry | None = None
    for entry in entries:
        item = entry.item
        around = source.around(entry, item)
        if isinstance(item, Root):
            if head is None:
                head = entry
                before += source.written((*around.before, *around.within))
                contents += source.written((*around.first, *around.after), beside=not contents)
                end_of_block += source.written(around.last)
            continue
        if not entry.in_root:
            contents += end_of_block
            end_of_block = []
        if isinstance(item, Include):
            source.put(contents, _include(source, entry, item, included_as), around)
        elif isinstance(item, Tree):
            source.put(contents, trees.element(entry, item), around)
            models.trees.append((entry, item))
        elif isinstance(item, Model):
            source.put(models.loose, model_element(source, entry, item), around)
        elif isinstance(item, ModelsItem):
            _models(source, entry, item, contents, models)
        elif isinstance(item, Verbatim):
            source.put(contents, source.raw(entry, item), around)
        else:  # other items have no element, nor have the comments in them
            contents += source.written(around.before)
    missing = {} if source.verbatim else undeclared(source.workspace, source.path)
    guessed.update({name: node.category for name, node in missing.items() if node.stated_category is None})
    contents += models.rest(source, (suggested_model(name, node) for name, node in missing.items()))
    contents += end_of_block
    end = source.written(source.comments.get(len(source.file.text), NO_COMMENTS).before)
    has_block = any(entry.in_root for entry in entries)
    (after if has_block else contents).extend(end)
    root.attributes = tuple(_root_attributes(source, head))
    return Document([*before, root, *after])


def _models(
    source: ExportSource, entry: Entry, item: ModelsItem, contents: list[Content], models: ModelCollector
) -> None:
    """Merge all models into one `TreeNodesModel`, for the engine accepts only one."""
    around = source.around(entry, item)
    if models.palettes and not source.verbatim:
        message = "its models move to the first TreeNodesModel: the engine accepts only one"
        source.repair(entry, item, message)
        element = models.palettes[0]
        contents += source.written((*around.before, *around.within, *around.after))
    else:
        element = Element("TreeNodesModel")
        models.palettes.append(element)
        source.put(contents, element, around)
    element.children.extend(source.written(around.first, beside=True))
    for part in item.models:
        part_element = source.raw(entry, part) if isinstance(part, Verbatim) else model_element(source, entry, part)
        source.put(element.children, part_element, source.around(entry, part))
    element.children.extend(source.written(around.last))


def _include(source: ExportSource, entry: Entry, include: Include, included_as: IncludedAs) -> Element:
    attributes = []
    if include.path is not None:
        target = source.workspace.included_by(source.path, include)
        text = include.path.text
        if target is not None and (is_mission(source.workspace, target) or not source.verbatim):
            name = escape(included_as(target))
        else:
            name = spelt(include.path) if not text.endswith(SUFFIXES) else escape(xml_name(text))
        attributes.append(Attribute("path", name))
    return Element("include", only_first(attributes + attributes_of(source, entry, include.attributes)))


def _root_attributes(source: ExportSource, head: Entry | None) -> list[Attribute]:
    """BTCPP_format and main_tree_to_execute: as written, and added where they are missing."""
    item = head.item if head is not None else None
    root = item if isinstance(item, Root) else None
    attributes: list[Attribute] = []
    if root is not None and root.name is not None:
        attributes.append(Attribute("main_tree_to_execute", source.spelt_tree(root.name)))
    if root is None or not root.bracketed:
        attributes.insert(0, _FORMAT)
    elif head is not None:
        attributes = only_first(attributes + attributes_of(source, head, root.attributes))
    if source.verbatim:
        return attributes
    names = {attribute.name for attribute in attributes}
    if "BTCPP_format" not in names:
        if root is not None and head is not None:
            source.repair(head, root, 'BTCPP_format="4" is added to the root')
        attributes.insert(0, _FORMAT)
    main = _main_tree(source)
    if "main_tree_to_execute" not in names and main is not None:
        attributes.append(Attribute("main_tree_to_execute", escape(source.tree_id(main.symbol.name))))
    return attributes


def _main_tree(source: ExportSource) -> Definition | None:
    """The tree that runs when the engine loads the document; None if it is in a file that is registered beside it."""
    workspace = source.workspace
    own = workspace.closure(source.path)
    main = workspace.main_tree(source.path)
    if main is None or main.path in own:
        return main
    if not source.is_bundled or workspace.factory is None:
        return None
    mains = [source.scope.find(Kind.TREE, name) for name in workspace.factory.main]
    return next((each for each in mains if each is not None and each.path in own), main)


_FORMAT: Final = Attribute("BTCPP_format", "4")
