"""Names that the engine refuses, and names that two nodes share."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.names import instance_name_problem, legal_name, model_name_problem, port_name_problem
from btq_lang.checks.kinds import written
from btq_lang.checks.ports import is_placeholder
from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.rules import Severity
from btq_lang.syntax import Entry, Model, Models, Tree, Word


def forbidden_name(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """The name of a tree, a node, an instance or a SubTree's port that the engine refuses at load."""
    version = view.workspace.project.target
    for what, name, reason in _refused(view, entry, version):
        fixes: tuple[Fix, ...] = ()
        legal = legal_name(name.text)
        if what in ("tree", "node"):
            title = f"Replace it by `{legal}`, here only"
            fixes = (replace_fix(title, name.span, written(legal)),)
        message = f"the engine refuses the {what} name `{name.text}`: {reason}"
        yield Diagnostic("forbidden-name", name.span, message, fixes=fixes)


def duplicate_instance_name(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """Two nodes of a tree with one name: their paths are one path, in logs and in Groot."""
    first: dict[tuple[bool, str], Word] = {}
    for seen in view.nodes(entry):
        name = seen.node.name
        if name is None:
            continue
        text = name.text
        if seen.node.id is not None and text == seen.node.id.text and not seen.is_subtree:
            continue  # the engine tells such nodes apart by their number
        if is_placeholder(seen) and legal_name(text) == text:
            continue  # the name becomes the ID, and no instance name is left
        other = first.setdefault((seen.is_subtree, text), name)
        if other is name:
            continue
        related = (Related(Place(other.span), "the first one"),)
        if seen.is_subtree:
            message = f"two SubTrees of this tree are called `{text}`: the engine refuses that"
            yield Diagnostic("duplicate-instance-name", name.span, message, related=related, severity=Severity.ERROR)
        else:
            message = f"two nodes of this tree are called `{text}`: logs cannot tell them apart"
            yield Diagnostic("duplicate-instance-name", name.span, message, related=related)


def _refused(view: View, entry: Entry, version: str) -> Iterator[tuple[str, Word, str]]:
    item = entry.item
    if isinstance(item, Tree):
        if item.name is not None and (reason := model_name_problem(item.name.text, version)):
            yield "tree", item.name, reason
        for seen in view.nodes(entry):
            name = seen.node.id
            checked = seen.is_subtree or (seen.node.category is None and seen.kind is None)
            if checked and name is not None and (reason := model_name_problem(name.text, version)):
                yield "tree" if seen.is_subtree else "node", name, reason
            label = seen.node.name
            if label is not None and (reason := instance_name_problem(label.text, version)):
                yield "instance", label, reason
    elif isinstance(item, Model | Models):
        for model in (item,) if isinstance(item, Model) else item.models:
            if not isinstance(model, Model) or model.category.raw != "SubTree":
                continue
            for port in model.ports:
                if port.name is not None and (reason := port_name_problem(port.name.text, version)):
                    yield "port", port.name, reason
