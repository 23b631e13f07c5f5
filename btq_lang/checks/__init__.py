"""The checks: what is wrong with a file beyond its syntax.

One invariant: a check is a function of the view of a file and one of its entries, and yields diagnostics whose spans
count from that entry; it never raises, whatever the file.  A module holds the rules of one subject.
"""

from __future__ import annotations

from itertools import chain

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
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, Related
from btq_lang.project import configured
from btq_lang.record import Record
from btq_lang.rules import Severity
from btq_lang.scan import line_start
from btq_lang.syntax import (
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

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from typing import TypeAlias

    from btq_lang.checks.answers import Answers
    from btq_lang.facts import Facts
    from btq_lang.workspace import Workspace

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
        elsewhere: the places that count from other items, and so move with these.
    """

    diagnostics: tuple[Diagnostic, ...]
    restless: tuple[Check, ...]
    elsewhere: tuple[Place, ...]


def check(
    workspace: Workspace, path: str, answers: Answers | None = None, *, is_alone: bool = False
) -> tuple[Diagnostic, ...]:
    """All that is wrong with a file, in the order of its text.

    Args:
        path: one of the workspace's files.
        answers: what earlier checks of the file have left here, to ask no more than an edit asks for.
        is_alone: say nothing of what is wrong in the files that it includes.

    Returns:
        Diagnostics as the project asks for them (severities, selection, suppressions); their spans count from the
        start of the file, and so do all their places.

    Raises:
        KeyError: there is no such file.
    """
    view = View(workspace, path, answers)
    file = workspace.files[path]
    if answers is not None:
        answers.begin(view, workspace)
    if answers is None:
        found = []
        for entry in file.parsed.entries:
            checks = checks_of(entry)
            if is_alone:
                checks = tuple(each for each in checks if each is not includes.include_with_errors)
            of_entry = [diagnostic for each in checks for diagnostic in each(view, entry)]
            if of_entry or entry.diagnostics:
                found += _told(view, entry, of_entry, workspace)
    else:
        found = _known(view, workspace, answers)
        answers.end()
    if file.has_directives:
        from btq_lang.checks.suppressions import Suppressions  # few files have any

        suppressions = Suppressions(file)
        found = [each for each in (*found, *suppressions.useless) if not suppressions.silence(each)]
    if workspace.origins:
        from btq_lang.checks.origins import shown_on_origins  # few workspaces have any

        found = shown_on_origins(workspace, path, found)
    found = list(configured(workspace.project, found))
    return tuple(sorted(found, key=lambda diagnostic: (diagnostic.span, diagnostic.rule)))


def _told(view: View, entry: Entry, found: Iterable[Diagnostic], workspace: Workspace) -> list[Diagnostic]:
    """All that is to be told of an entry, as it counts in the file."""
    if entry.diagnostics:
        found = (*entry.diagnostics, *_on_sound_lines(found, entry, view.text))
    return [_placed(diagnostic, entry.start, workspace) for diagnostic in found]


def _known(view: View, workspace: Workspace, answers: Answers) -> list[Diagnostic]:
    """All that is to be told of the file's entries, from what is kept of each; most have nothing."""
    file = workspace.files[view.path]
    told: list[Diagnostic] = []
    before, answers.told = answers.told, {}
    found = answers.conclude_each(view, _kept, file.facts.values())
    for entry, facts, known in zip(file.parsed.entries, file.facts.values(), found, strict=True):
        if not (known.diagnostics or known.restless or entry.diagnostics):
            continue
        same = before.get(facts)
        starts = [entry.start, *[_start(place, workspace) for place in known.elsewhere]]
        if same is None or same[0] is not known or same[1] != starts or known.restless:
            restless = (diagnostic for each in known.restless for diagnostic in each(view, entry))
            same = known, starts, _told(view, entry, (*known.diagnostics, *restless), workspace)
        answers.told[facts] = same
        told += same[2]
    return told


def _kept(view: View, facts: Facts) -> Found:
    """What the checks find in an item, as far as they say what they ask for."""
    entry = view.entry(facts)
    found: list[Diagnostic] = []
    restless: list[Check] = []
    for each in checks_of(entry):
        diagnostics = view.watched(each, entry)
        if diagnostics is None:
            restless.append(each)
        else:
            found += diagnostics
    places = (each.place for diagnostic in found for each in diagnostic.related)
    changed = (change.place for diagnostic in found for fix in diagnostic.fixes for change in fix.changes)
    elsewhere = {id(place.anchor): place for place in chain(places, changed) if place.anchor is not None}
    return Found(tuple(found), tuple(restless), tuple(elsewhere.values()))


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


def _placed(one: Diagnostic, by: int, workspace: Workspace) -> Diagnostic:
    """A diagnostic of an entry that begins at `by`, with every place counted from the start of its file.

    After an edit this is asked of all that stands behind it, so it is made in one go.
    """
    related: tuple[Related, ...] = ()
    fixes: tuple[Fix, ...] = ()
    if one.related:
        related = tuple([Related(_absolute(each.place, by, workspace), each.message) for each in one.related])
    if one.fixes:
        fixes = tuple(
            [
                Fix(
                    fix.title,
                    tuple([Change(_absolute(each.place, by, workspace), each.text) for each in fix.changes]),
                    fix.safe,
                )
                for fix in one.fixes
            ]
        )
    return Diagnostic(one.rule, one.span.shifted(by), one.message, related, one.notes, fixes, one.tags, one.severity)


def _absolute(place: Place, by: int, workspace: Workspace) -> Place:
    if place.anchor is None:
        return place if place.path is not None else Place(place.span.shifted(by))
    if place.path is None:
        return place
    return Place(place.span.shifted(_start(place, workspace)), place.path)


def _start(place: Place, workspace: Workspace) -> int:
    """Where the item begins that a place counts from."""
    return workspace.files[place.path].start_of(place.anchor) if place.path is not None else 0
