"""`btq nodes`: the nodes that C++ sources register, as models or as a page."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Final, TypeAlias

from btq_lang.btcpp import reader
from btq_lang.btcpp.document import Element
from btq_lang.catalog.cpp_classes import ENGINE
from btq_lang.commands.output import write_output
from btq_lang.cpp.findings import UNSEEN, findings, nothing_registered
from btq_lang.cpp.grammar import GrammarMissing
from btq_lang.cpp.model import CppNodes
from btq_lang.cpp.nodes import read_nodes
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.projects.cpp_files import MISSING, distributions_of
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Span, counted
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, collect, find_project, head, read, shown, without_tests

Exported: TypeAlias = tuple[str, tuple[Diagnostic, ...]]  # the text, and what its nodes leave unseen

FORMATS = ("btq", "xml", "html")


class NodesOptions(Record):
    """The options of `btq nodes`; `paths`: C++ files and folders."""

    paths: Sequence[str]
    format: str | None
    output: str | None


def run(options: NodesOptions, messages: CommandOutput) -> int:
    """Write the nodes, and remarks on what is wrong or cannot be seen."""
    form = options.format or os.path.splitext(options.output or "")[1].lower().removeprefix(".") or FORMATS[0]
    project = find_project(options.paths[0]).project
    files, exported, problems = _cpp_texts(options.paths, project)
    if form not in FORMATS:
        problems.append(f"btq nodes: cannot write {options.output}; choose one of {', '.join(FORMATS)} with --format")
    elif form != "html" and options.output and not _is_ours(options.output):
        problems.append(f"btq nodes: {options.output} exists, and btq nodes did not make it; choose another file name")
    elif not files and not exported and not problems:
        problems.append(f"btq nodes: no C++ file below {', '.join(options.paths)}")
    for problem in problems:
        messages.remark(problem)
    if problems:
        return 2
    try:
        cpp_nodes = read_nodes(files, distributions_of(project))
    except GrammarMissing as error:
        raise Refused(MISSING) from error
    sources = " ".join(options.paths)
    write_output(messages, options.output, _as_text(cpp_nodes, form, sources))
    remarks = findings(cpp_nodes, files) | {path: nodes for path, (_, nodes) in exported.items() if nodes}
    texts = files | {path: text for path, (text, _) in exported.items()}
    for path in sorted(remarks):
        lines = LineIndex(texts[path])
        for remark in remarks[path]:
            line, column = lines.position(remark.span.start)
            what = f"{remark.effective_severity.value}[{remark.rule}] {remark.message}"
            messages.remark(f"{path}:{line + 1}:{column + 1}: {what}")
    is_empty = bool(files) and not cpp_nodes.nodes and not remarks
    if is_empty:
        messages.remark(f"btq nodes: {nothing_registered(files)}")
    ports = sum(len(node.ports) for node in cpp_nodes.nodes)
    counts = counted(len(cpp_nodes.nodes), "node"), counted(ports, "port"), counted(len(files), "file")
    messages.remark("{} with {} in {}".format(*counts))
    return int(bool(remarks) or is_empty)


def _cpp_texts(paths: Sequence[str], project: Project) -> tuple[dict[str, str], dict[str, Exported], list[str]]:
    """The C++ files below some paths, by shown path, the XML of pluginlib, and files that cannot be read; folders are
    left out as in a pattern of `nodes` in the project file."""
    problems: list[LoadProblem] = []
    candidates: dict[str, None] = {}
    for top in map(absolute, paths):
        below, unreachable = collect([top], project, (*CPP_SUFFIXES, ".xml"))
        problems += unreachable
        candidates.update(dict.fromkeys(below if top in below else without_tests(below, top)))
    texts = {}
    exported: dict[str, Exported] = {}
    for path in candidates:
        text, problem = read(path)
        if path.endswith(".xml"):
            if text is not None and (nodes := exported_nodes(text)) is not None:
                exported[shown(path)] = text, nodes
            elif path in map(absolute, paths):
                problems.append(problem or LoadProblem(path, "neither C++ nor what pluginlib reads"))
        elif text is not None:  # bytes that are not UTF-8 are mostly in comments
            texts[shown(path)] = text
        elif problem is not None:
            problems.append(problem)
    return texts, exported, [f"btq: {problem}" for problem in problems]


def _is_ours(path: str) -> bool:
    from btq_lang.projects.node_writers import MADE_BY

    target = absolute(path)
    return path == "-" or not os.path.lexists(target) or MADE_BY in head(target)


def _as_text(cpp_nodes: CppNodes, form: str, sources: str) -> str:
    if form == "html":
        from btq_lang.projects.node_writers import as_html

        return as_html(cpp_nodes, sources)
    from btq_lang.projects.node_writers import as_btq, as_xml

    return (as_btq if form == "btq" else as_xml)(cpp_nodes.nodes, sources)


def exported_nodes(text: str) -> tuple[Diagnostic, ...] | None:
    """The nodes that a file exports, each as what cannot be seen, because the program that loads it gives the ID.

    None if it is not for pluginlib.

    Source: https://wiki.ros.org/pluginlib/PluginDescriptionFile
    """
    document = reader.read(text).document
    if document is None or document.root.tag not in _ROOTS:
        return None
    return tuple(_exported_classes(document.root))


def _exported_classes(element: Element) -> Iterator[Diagnostic]:
    for child in element.elements:
        base = child.get("base_class_type") or ""
        if child.tag == "class" and base.startswith("BT::") and base.removeprefix("BT::") in ENGINE:
            name = child.get("type") or ""
            message = f"exports `{name}`, a {base}, to pluginlib; under which ID trees have it cannot be seen"
            yield Diagnostic(UNSEEN, Span(child.start, child.end), message)
        yield from _exported_classes(child)


_ROOTS: Final = ("library", "class_libraries")
