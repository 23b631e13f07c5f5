"""A factory: what one program registers before it creates a tree, as `[[factory]]` in the project file says.

    [[factory]]
    name = "navigation"
    load = ["trees/*.xml", "package://docking/trees/*.xml"]    # in the order in which the program registers them
    main = ["Navigate", "Dock"]                                # a tree, or a list of them
    nodes = ["nav2-jazzy", "models/*.xml"]                     # where the nodes are declared that it registers
    nav2 = "config/nav2_params.yaml"                           # what bt_navigator loads; `load` is then for goals

One invariant: what is wrong is left out and reported, and the rest is kept.  Not known here: which files the patterns
match, which the loader fills in, and what is in them.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.record import Record, replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.catalog.nav2.navigator import OutsideEntry

# The message, the keys below `factory` to its place, and the string that it is about.
Complaint: TypeAlias = tuple[str, tuple[str, ...], str | None]


class Factory(Record):
    """The files and nodes that one program registers.

    Attributes:
        name: as messages call it.
        load: patterns of the files that it registers.
        main: the trees that it may create; empty: unknown.
        nodes: patterns of files whose models declare the nodes that it registers, or of C++ sources that register
            them, and names of nodes that btq knows.
        nav2: the parameter file of a bt_navigator, which is a factory for each tree that it creates.
        files: those of `load`, in order, each once.
        node_files: those of `nodes` that are not in `files`.
        cpp_files: the C++ sources of `nodes`.
        lost: the patterns that match no file: what the program registers is then unknown in part.
        has_gaps: whether bt_navigator registers files that are not here; its parameter file has the diagnostics.
        entries: of the root blackboard, which the program sets or reads, if it is known to be bt_navigator.
        period: from one tick to the next, in milliseconds, if it is bt_navigator.
        goals: what is wrong with trees that nodes name for goals, by this name.
        libraries: those that the parameters name for bt_navigator to load.
        unloaded: the C++ sources of libraries that it does not load.
    """

    name: str
    load: tuple[str, ...] = ()
    main: tuple[str, ...] = ()
    nodes: tuple[str, ...] = ()
    nav2: str = ""
    files: tuple[str, ...] = ()
    node_files: tuple[str, ...] = ()
    cpp_files: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()
    has_gaps: bool = False
    entries: tuple[OutsideEntry, ...] = ()
    period: int = 10
    goals: tuple[tuple[str, Diagnostic], ...] = ()
    libraries: tuple[str, ...] = ()
    unloaded: frozenset[str] = frozenset()


def read_factories(tables: object) -> tuple[tuple[Factory, ...], list[Complaint]]:
    """The factories of a project file, and what is wrong with them."""
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        return (), [("`factory` must be a list of tables: `[[factory]]`", (), None)]
    complaints: list[Complaint] = []
    factories: list[Factory] = []
    for number, table in enumerate(tables):
        place = (f"[{number}]",)
        for key in table:
            if key not in KEYS:
                complaints.append(
                    (f"unknown key `factory.{key}`{did_you_mean(near(key, KEYS, 1))}", (*place, key), None)
                )
        values = {key: _strings(table[key], key) if key in table else () for key in KEYS}
        for key, value in values.items():
            if value is None:
                form = _FORMS.get(key, "a list of strings")
                complaints.append((f"`factory.{key}` must be {form}", (*place, key), None))
        for source in values["nodes"] or ():
            if _is_name(source) and source not in PACKAGED:
                message = f"unknown nodes `{source}`{did_you_mean(near(source, PACKAGED, 1))}"
                complaints.append((message, (*place, "nodes"), source))
        values["nodes"] = tuple(each for each in values["nodes"] or () if not _is_name(each) or each in PACKAGED)
        name = values["name"][0] if values["name"] else ""
        if values["name"] is not None and not name:
            complaints.append(("a factory needs a `name`", place, None))
        elif any(name == each.name for each in factories):
            complaints.append((f"duplicate factory `{name}`", (*place, "name"), name))
        elif name:
            nav2 = (values["nav2"] or ("",))[0]
            factories.append(Factory(name, values["load"] or (), values["main"] or (), values["nodes"] or (), nav2))
    return tuple(factories), complaints


def merged(results: Sequence[tuple[Factory | None, tuple[Diagnostic, ...]]]) -> tuple[Diagnostic, ...]:
    """The diagnostics of a file from each of its factories, in order; those that only some have name them.

    What is an error in one is not repeated as a warning of another, which does not create the tree.
    """
    if len(results) == 1:
        return results[0][1]
    factories_of: dict[Diagnostic, list[str]] = {}
    for factory, diagnostics in results:
        for diagnostic in dict.fromkeys(diagnostics):
            factories_of.setdefault(diagnostic, []).append(f"`{factory.name}`" if factory is not None else "")
    errors = {_identity(each) for each in factories_of if each.effective_severity is Severity.ERROR}
    kept = [
        diagnostic
        for diagnostic in factories_of
        if diagnostic.effective_severity is Severity.ERROR or _identity(diagnostic) not in errors
    ]
    return tuple(
        _with_factories(diagnostic, factories_of[diagnostic])
        if len(factories_of[diagnostic]) < len(results)
        else diagnostic
        for diagnostic in sorted(kept, key=attrgetter("span"))
    )


def _identity(diagnostic: Diagnostic) -> tuple[str, Span, str]:
    """The identity of a diagnostic, whatever its severity."""
    return diagnostic.rule, diagnostic.span, diagnostic.message


def _with_factories(diagnostic: Diagnostic, factories: list[str]) -> Diagnostic:
    note = f"only in the factor{'y' if len(factories) == 1 else 'ies'} {', '.join(factories)}"
    return replace(diagnostic, notes=(*diagnostic.notes, note))


def _is_name(source: str) -> bool:
    """Whether nodes are named, and not a pattern of files."""
    return source.startswith("nav2-") and not {*source} & {*"/*."}


def _strings(value: object, key: str) -> tuple[str, ...] | None:
    """The strings of a value; None if it is anything else."""
    if isinstance(value, str) and key in _FORMS:
        return (value,) if value or key == "name" else None  # that it needs one is reported
    if not isinstance(value, list) or key in ("name", "nav2"):
        return None
    return tuple(value) if all(isinstance(each, str) and each for each in value) else None


_FORMS: Final = {"name": "a string", "main": "a tree or a list of trees", "nav2": "the name of a file"}
# Each key with a line for editors.
KEYS: Final = {
    "name": "the name of the factory in messages",
    "load": "patterns of the files that the program registers, in order; also package://NAME/…",
    "main": "the tree that the program creates, or a list of them",
    "nodes": "patterns of the files that declare the program's nodes, or of C++ sources, and names such as nav2-jazzy",
    "nav2": "the parameter file of Nav2's bt_navigator, which says which trees and libraries it loads",
}
