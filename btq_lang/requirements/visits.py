"""Reading the nodes that `visits` names: a path, and perhaps the values that its ports have when it starts.

One invariant: a node whose port has another value in the tree is left out; what an entry holds is known only in a log.
"""

from __future__ import annotations

from btq_lang.diagnostics.model import write_fix
from btq_lang.requirements import model, nodes
from btq_lang.requirements.reader import Reader
from btq_lang.syntax import tree as syntax
from btq_lang.workspace.resolved import ResolvedNode


def visits_of(reader: Reader, written: tuple[syntax.NodeRef, ...]) -> tuple[model.Visit, ...] | None:
    """What has to be visited; None if one of them was not understood."""
    visits = [_visit(reader, each) for each in written]
    understood = tuple(visit for visit in visits if visit is not None)
    return understood if written and len(understood) == len(written) else None


def _visit(reader: Reader, written: syntax.NodeRef) -> model.Visit | None:
    text = reader.text(written.start, written.end)
    names = tuple(name.text for name in written.path.names)
    targets = reader.find(names)
    if not written.pairs or not targets:
        if len(names) == 1 and not targets and _report_value(reader, written.path.names[0]):
            return None
        target = reader.target(written.path)
        return model.Visit(text, (model.VisitedNode(target),)) if target is not None else None
    visited = [_visited(reader, target, written.pairs) for target in targets]
    fitting = tuple(each for each in visited if each is not None)
    if not fitting:
        path = "/".join(name.raw for name in written.path.names)
        reader.complain("unmatched-path", written.span, f"no node `{path}` has these values: `{text}`")
        return None
    return model.Visit(text, fitting)


def _visited(reader: Reader, target: model.NodeTarget, pairs: tuple[syntax.Pair, ...]) -> model.VisitedNode | None:
    """A node with the entries that its ports read; None if a port has another value."""
    given = {pair.key.text: pair.value for pair in target.node.node.attributes}
    read: list[tuple[model.ResolvedSignal, str]] = []
    for pair in pairs:
        value = given.get(pair.key.text)
        if value is None or pair.value is None:
            return None
        if value.text == pair.value.text:
            continue
        if not (value.text.startswith("{") and value.text.endswith("}")):
            return None
        entry = value.text[1:-1].strip()
        entry = pair.key.text if entry == "=" else entry
        signal = model.ResolvedSignal(entry, "text", None, entry, "gauge", None, None, reader.place(pair.key.span))
        read.append((signal, pair.value.text))
    return model.VisitedNode(target, tuple(read))


def _report_value(reader: Reader, name: syntax.Word) -> bool:
    """Report a name that no node has, but a port as its value: `Dock` for `MoveTo (station = "Dock")`."""
    ports = reader.store.ask(nodes.ports_with, reader.viewpoint, name.text)
    if not ports:
        return False
    fixes = tuple(write_fix(f"{_named(node)} ({port} = {syntax.quote(name.text)})", name.span) for node, port in ports)
    message = f"unknown node `{name.raw}`; it is the value of a port"
    reader.complain("unmatched-path", name.span, message, fixes=fixes)
    return True


def _named(node: ResolvedNode) -> str:
    word = node.node.id or node.node.name
    return syntax.written(word.text) if word is not None else ""
