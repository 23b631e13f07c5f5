"""The checks: what is wrong with a file beyond its syntax.

One invariant: a check is a function of the view of a file and one of its entries, and yields diagnostics whose spans
count from that entry; it never raises, whatever the file.  A module holds the rules of one subject, and `CHECKS` below
says which function looks at which items.  Not known here: what an edit changed, and how findings are printed.

    view.py, seen.py   what a check sees: its file, and the nodes of a tree sorted by what checks look for
    answers.py, lookups.py   what it asks of other items, kept from one edit to the next
    kinds.py, names.py, ports.py, children.py, trees.py, includes.py   what the engine would refuse
    literals.py, constants.py, strings.py, scripts.py, counts.py, empty.py, outputs.py   values
    entries.py, pointers.py, writers.py, misspelt.py, mixed_types.py   blackboard entries
    statuses.py, results.py, unreachable.py, reactive.py, preconditions.py, swallowing.py   what nodes return, and traps
    measures.py, clauses.py, conditions.py, bounds.py, limits.py, odds.py   requirements by themselves
    requirements.py, attached.py, qualities.py, repeated.py, prose.py, unused.py   names of requirements and qualities
    demanded.py, demands.py, budgets.py, signals.py, renewals.py, unenforced.py   requirements at their nodes
    calls.py, origins.py, wording.py, placeholders.py, suppressions.py   what these share, XML, and silenced rules
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.checks import (
    bounds,
    children,
    clauses,
    conditions,
    constants,
    counts,
    demands,
    empty,
    includes,
    kinds,
    literals,
    measures,
    misspelt,
    mixed_types,
    names,
    outputs,
    placeholders,
    ports,
    preconditions,
    prose,
    qualities,
    reactive,
    repeated,
    requirements,
    scripts,
    trees,
    unreachable,
    unused,
)
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Entry,
    Include,
    Model,
    Models,
    Qualities,
    QualityDecl,
    Requirement,
    Root,
    Signal,
    Tree,
)
from btq_lang.util.record import Record
from btq_lang.workspace.config import configured
from btq_lang.workspace.findings import Findings, Told

if TYPE_CHECKING:
    from btq_lang.checks.answers import Answers
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.item_index import Facts
    from btq_lang.workspace.workspace import Workspace

Check: TypeAlias = "Callable[[View, Entry], Iterator[Diagnostic]]"

# The checks of each kind of item: most items are small, and most checks have nothing to say of most of them.
CHECKS: dict[type, tuple[Check, ...]] = {
    Include: (
        includes.missing_include,
        includes.cyclic_include,
        includes.include_with_errors,
        trees.duplicate_tree,
        kinds.duplicate_definition,
        requirements.conflicting_requirement,
        ports.duplicate_attribute,
    ),
    Root: (trees.unknown_tree, empty.empty_text, ports.duplicate_attribute),
    Tree: (
        trees.unknown_tree,
        trees.duplicate_tree,
        trees.recursive_tree,
        trees.unused_tree,
        trees.unknown_main_tree,
        trees.tree_root_count,
        trees.nested_too_deep,
        trees.tree_named_like_node,
        kinds.unknown_node,
        kinds.no_models,
        kinds.not_an_engine_node,
        kinds.newer_engine_node,
        kinds.category_mismatch,
        kinds.clause_as_node,
        ports.unknown_port,
        ports.missing_port,
        ports.unknown_attribute,
        ports.duplicate_attribute,
        ports.duplicate_port,
        ports.misspelt_type,
        literals.invalid_literal,
        literals.quantity_on_unitless_port,
        constants.number_for_text,
        mixed_types.entry_with_two_types,
        outputs.literal_for_output,
        counts.count_of_nothing,
        children.child_count,
        children.switch_cases,
        children.parallel_threshold,
        names.forbidden_name,
        names.duplicate_instance_name,
        placeholders.classic_placeholder,
        placeholders.placeholder_clash,
        scripts.script_error,
        misspelt.misspelt_entry,
        requirements.unknown_requirement,
        requirements.conflicting_requirement,
        requirements.requirement_without_text,
        clauses.duplicate_clause,
        clauses.clause_without_odds,
        clauses.unused_parameter,
        bounds.impossible_bound,
        bounds.uses_of_gauge,
        repeated.named_twice,
        empty.empty_text,
        qualities.unknown_quality,
        qualities.old_quality_name,
        qualities.ambiguous_quality,
        conditions.subtraction_without_blanks,
        prose.prose_constraint,
        reactive.reactive_multiple_async,
        reactive.explicit_in_reactive,
        reactive.condition_without_recheck,
        preconditions.one_shot_monitor,
        preconditions.while_skip_is_success,
        preconditions.skipped_condition,
        unreachable.unreachable_child,
        measures.unresolved,
        demands.demands,
    ),
    Model: (
        kinds.duplicate_definition,
        ports.duplicate_attribute,
        ports.duplicate_port,
        ports.misspelt_type,
        literals.invalid_literal,
        literals.quantity_on_unitless_port,
        constants.number_for_text,
        names.forbidden_name,
        empty.empty_text,
    ),
    Models: (
        kinds.duplicate_definition,
        ports.duplicate_attribute,
        ports.duplicate_port,
        ports.misspelt_type,
        literals.invalid_literal,
        literals.quantity_on_unitless_port,
        constants.number_for_text,
        names.forbidden_name,
        empty.empty_text,
    ),
    Signal: (kinds.duplicate_definition, empty.empty_text, unused.unused_signal, measures.unresolved, demands.demands),
    Context: (
        kinds.duplicate_definition,
        conditions.subtraction_without_blanks,
        unused.unused_context,
        measures.unresolved,
    ),
    Requirement: (
        requirements.conflicting_requirement,
        requirements.unused_requirement,
        requirements.requirement_without_text,
        clauses.duplicate_clause,
        clauses.clause_without_odds,
        clauses.unused_parameter,
        bounds.impossible_bound,
        bounds.uses_of_gauge,
        empty.empty_text,
        qualities.unknown_quality,
        qualities.old_quality_name,
        qualities.ambiguous_quality,
        conditions.subtraction_without_blanks,
        prose.prose_constraint,
        measures.unresolved,
        measures.requirement_without_subject,
        demands.demands,
    ),
    Apply: (requirements.unknown_requirement, repeated.named_twice, measures.unresolved, demands.demands),
    Qualities: (qualities.unknown_quality,),
    QualityDecl: (
        kinds.duplicate_definition,
        empty.empty_text,
        qualities.unknown_quality,
        qualities.old_quality_name,
        qualities.ambiguous_quality,
    ),
}


# After these mistakes nobody knows which node is whose child, so there is nothing to say of their number.
_STRUCTURE_IS_LOST = frozenset(
    ("inconsistent-indentation", "nested-too-deep", "string-over-items", "unclosed-string", "unclosed-bracket")
)
_OF_STRUCTURE: frozenset[Check] = frozenset(
    (
        trees.tree_root_count,
        trees.nested_too_deep,
        children.child_count,
        children.switch_cases,
        children.parallel_threshold,
        unreachable.unreachable_child,
    )
)
# Of models, of which a file has many, these look at nothing but the ports, and the others at those of models of trees.
_OF_PORTS: frozenset[Check] = frozenset(
    (ports.duplicate_port, ports.misspelt_type, literals.invalid_literal, literals.quantity_on_unitless_port)
)
_OF_PORTS_OF_TREES: frozenset[Check] = frozenset((constants.number_for_text, names.forbidden_name))
_OF_NODES = tuple(each for each in CHECKS[Model] if each not in _OF_PORTS_OF_TREES)
_WITHOUT_PORTS = tuple(each for each in _OF_NODES if each not in _OF_PORTS)


class Found(Record):
    """What was found in an item.

    Attributes:
        restless: the checks that must be asked again after every edit, for they look at the whole workspace.
    """

    diagnostics: tuple[Diagnostic, ...]
    restless: tuple[Check, ...]


def check(workspace: Workspace, path: str, *, is_alone: bool = False) -> tuple[Diagnostic, ...]:
    """All that is wrong with a file, in the order of its text.

        >>> from btq_lang import Workspace, check
        >>> workspace = Workspace.of({"main.btq": "BehaviorTree Main\\n    Sequnce\\n        Action Dock\\n"})
        >>> (found,) = check(workspace, "main.btq")
        >>> found.rule, found.fixes[0].title
        ('unknown-node', 'Replace `Sequnce` with `Sequence`')

    Args:
        path: one of the workspace's files.
        is_alone: say nothing of what is wrong in the files that it includes.

    Returns:
        Diagnostics as the project asks for them (severities, selection, suppressions); their spans count from the
        start of the file, and so do all their places.

    Raises:
        KeyError: there is no such file.
    """
    view = View(workspace, path)
    project = None if _looks_beyond(workspace, path) else workspace.project
    told: list[tuple[Told, list[int]]] = []
    for entry in workspace.files[path].parsed.entries:
        checks = checks_of(entry)
        if is_alone:
            checks = tuple(each for each in checks if each is not includes.include_with_errors)
        found = [diagnostic for each in checks for diagnostic in each(view, entry)]
        if found or entry.diagnostics:
            of_item = _told(view, entry, found, project)
            told.append((of_item, of_item.starts(workspace)))
    return (Findings(told) if project is not None else _wanted(workspace, path, Findings(told))).diagnostics


def check_again(workspace: Workspace, path: str, answers: Answers) -> Findings:
    """The same, asking no more than an edit asks for.

    Args:
        answers: what earlier checks of the file have left here.
    """
    view = View(workspace, path, answers)
    file = workspace.files[path]
    answers.begin(view, workspace)
    project = None if _looks_beyond(workspace, path) else workspace.project
    told: list[tuple[Told, list[int]]] = []
    before, answers.told = answers.told, {}
    found = answers.conclude_each(view, _kept, file.facts.values())
    for entry, facts, known in zip(file.parsed.entries, file.facts.values(), found, strict=True):
        if not (known.diagnostics or known.restless or entry.diagnostics):
            continue
        same = before.get(facts)
        if same is None or same[0] is not known or same[1] is not project or known.restless:
            restless = (diagnostic for each in known.restless for diagnostic in each(view, entry))
            same = known, project, _told(view, entry, (*known.diagnostics, *restless), project)
        answers.told[facts] = same
        if same[2].diagnostics:
            told.append((same[2], same[2].starts(workspace)))
    answers.end()
    return Findings(told) if project is not None else _wanted(workspace, path, Findings(told))


def _looks_beyond(workspace: Workspace, path: str) -> bool:
    """Whether what is to be told of an item is more than that and the project say."""
    return workspace.files[path].has_directives or bool(workspace.origins)


def _wanted(workspace: Workspace, path: str, found: Findings) -> Findings:
    """What is to be told of all that was found, where that takes more than each item and the project."""
    file = workspace.files[path]
    diagnostics: Iterable[Diagnostic] = found.diagnostics
    if file.has_directives:
        from btq_lang.checks.suppressions import Suppressions  # few files have any

        suppressions = Suppressions(file)
        diagnostics = [each for each in (*diagnostics, *suppressions.useless) if not suppressions.silence(each)]
    if workspace.origins:
        from btq_lang.checks.origins import shown_on_origins  # few workspaces have any

        diagnostics = shown_on_origins(workspace, path, diagnostics)
    return Findings.placed(configured(workspace.project, diagnostics))


def _told(view: View, entry: Entry, found: Iterable[Diagnostic], project: Project | None) -> Told:
    """All that is to be told of an entry, as the project wants it; None: that is not to be asked yet."""
    if entry.diagnostics:
        found = (*entry.diagnostics, *_on_sound_lines(found, entry, view.text))
    return Told(found if project is None else configured(project, found), (view.path, entry.item))


def _kept(view: View, facts: Facts) -> Found:
    """What the checks find in an item, as far as they say what they ask for."""
    entry = view.entry(facts)
    checks = checks_of(entry)
    restless: list[Check] = []
    found = view.watched(checks, entry)
    if found is None:  # one of them does, in few items: to watch each by itself takes longer
        found = []
        for each in checks:
            diagnostics = view.watched((each,), entry)
            if diagnostics is None:
                restless.append(each)
            else:
                found += diagnostics
    return Found(tuple(found), tuple(restless))


def checks_of(entry: Entry) -> tuple[Check, ...]:
    """The checks that may have something to say of an entry."""
    item = entry.item
    checks = CHECKS.get(type(item), ())
    if type(item) is Model and not item.body:
        return _WITHOUT_PORTS
    if type(item) is Model and item.category.raw != "SubTree":
        return _OF_NODES
    if entry.diagnostics and any(problem.rule in _STRUCTURE_IS_LOST for problem in entry.diagnostics):
        checks = tuple(each for each in checks if each not in _OF_STRUCTURE)
    return checks


def _on_sound_lines(found: Iterable[Diagnostic], entry: Entry, text: str) -> Iterator[Diagnostic]:
    """What is not on a line with a syntax error: what a line means is not known before it can be read."""
    broken = {_line(text, entry, each) for each in entry.diagnostics if each.effective_severity is Severity.ERROR}
    return (each for each in found if _line(text, entry, each) not in broken)


def _line(text: str, entry: Entry, diagnostic: Diagnostic) -> int:
    return line_start(text, entry.start, entry.start + diagnostic.span.start)
