"""The checks: what is wrong with a file beyond its syntax.

One invariant: a check is a function of the view of a file and one of its entries, and yields diagnostics whose spans
count from that entry; it never raises, whatever the file.  A module holds the rules of one subject.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from btq_lang.checks import (
    children,
    clauses,
    conditions,
    constants,
    counts,
    demands,
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
    requirements,
    scripts,
    trees,
    unreachable,
)
from btq_lang.checks.origins import shown_on_origins
from btq_lang.checks.view import Noted, View
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, Related, shifted
from btq_lang.project import Project, configured
from btq_lang.record import record, replace
from btq_lang.rules import Severity
from btq_lang.scan import line_start
from btq_lang.symbols import Kind, Symbol
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
from btq_lang.text import Span
from btq_lang.workspace import File, Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import TypeAlias

Check: TypeAlias = Callable[[View, Entry], Iterator[Diagnostic]]

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
    Root: (trees.unknown_tree, ports.duplicate_attribute),
    Tree: (
        trees.unknown_tree,
        trees.duplicate_tree,
        trees.recursive_tree,
        trees.unused_tree,
        trees.unknown_main_tree,
        trees.tree_root_count,
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
    ),
    Signal: (kinds.duplicate_definition, measures.unresolved, demands.demands),
    Context: (kinds.duplicate_definition, conditions.subtraction_without_blanks, measures.unresolved),
    Requirement: (
        requirements.conflicting_requirement,
        requirements.unused_requirement,
        requirements.requirement_without_text,
        clauses.duplicate_clause,
        clauses.clause_without_odds,
        clauses.unused_parameter,
        qualities.unknown_quality,
        qualities.old_quality_name,
        qualities.ambiguous_quality,
        conditions.subtraction_without_blanks,
        prose.prose_constraint,
        measures.unresolved,
        measures.requirement_without_subject,
        demands.demands,
    ),
    Apply: (requirements.unknown_requirement, measures.unresolved, demands.demands),
    Qualities: (qualities.unknown_quality,),
    QualityDecl: (
        kinds.duplicate_definition,
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
        children.child_count,
        children.switch_cases,
        children.parallel_threshold,
        unreachable.unreachable_child,
    )
)


# What these find in an item depends on the item, and of all else only on what a view notes: so it holds until an edit
# changes the item, or one of the answers.  The others look further, and are asked after every edit.
_NARROW: frozenset[Check] = frozenset(
    (
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
        counts.count_of_nothing,
        children.child_count,
        children.switch_cases,
        children.parallel_threshold,
        names.forbidden_name,
        names.duplicate_instance_name,
        placeholders.classic_placeholder,
        scripts.script_error,
        qualities.old_quality_name,
        qualities.ambiguous_quality,
        conditions.subtraction_without_blanks,
        clauses.duplicate_clause,
        clauses.clause_without_odds,
        clauses.unused_parameter,
    )
)


@record
class Kept:
    """What the narrow checks found in an item, and the answers that this rests on."""

    entry: Entry
    project: Project
    found: tuple[Diagnostic, ...]
    noted: Noted


def check(workspace: Workspace, path: str, kept: dict[int, Kept] | None = None) -> tuple[Diagnostic, ...]:
    """All that is wrong with a file, in the order of its text.

    Args:
        path: one of the workspace's files.
        kept: what an earlier check of the file has left here, to ask no more than an edit asks for; left anew.

    Returns:
        Diagnostics as the project asks for them (severities, selection, suppressions); their spans count from the
        start of the file, and so do all their places.

    Raises:
        KeyError: there is no such file.
    """
    view = View(workspace, path)
    noting = View(workspace, path, notes=True)
    found: list[Diagnostic] = []
    before = dict(kept or {})
    if kept is not None:
        kept.clear()
    for entry in view.file.parsed.entries:
        checks = CHECKS.get(type(entry.item), ())
        if any(problem.rule in _STRUCTURE_IS_LOST for problem in entry.diagnostics):
            checks = tuple(each for each in checks if each not in _OF_STRUCTURE)
        diagnostics: list[Diagnostic] = []
        if kept is not None and _can_be_kept(entry):
            narrow = kept[id(entry.item)] = _narrow(noting, entry, checks, before.get(id(entry.item)))
            diagnostics += narrow.found
            checks = tuple([each for each in checks if each not in _NARROW])
        diagnostics += [diagnostic for each in checks for diagnostic in each(view, entry)]
        if entry.diagnostics:
            diagnostics = [*entry.diagnostics, *_on_sound_lines(diagnostics, entry, view.file.text)]
        found += [_placed(shifted(diagnostic, entry.start), workspace) for diagnostic in diagnostics]
    if "btq:" in view.file.text:
        from btq_lang.checks.suppressions import Suppressions  # few files have any

        suppressions = Suppressions(view.file)
        found = [each for each in (*found, *suppressions.useless) if not suppressions.silence(each)]
    found = list(configured(workspace.project, shown_on_origins(workspace, path, found)))
    return tuple(sorted(found, key=lambda diagnostic: (diagnostic.span, diagnostic.rule)))


def _on_sound_lines(found: list[Diagnostic], entry: Entry, text: str) -> Iterator[Diagnostic]:
    """What is not on a line with a syntax error: what a line means is not known before it can be read."""
    broken = {_line(text, entry, each) for each in entry.diagnostics if each.effective_severity is Severity.ERROR}
    return (each for each in found if _line(text, entry, each) not in broken)


def _line(text: str, entry: Entry, diagnostic: Diagnostic) -> int:
    return line_start(text, entry.start, entry.start + diagnostic.span.start)


def _can_be_kept(entry: Entry) -> bool:
    """A tree without a name is told what else stands in the file."""
    return not isinstance(entry.item, Include) and not (isinstance(entry.item, Tree) and entry.item.name is None)


def _narrow(view: View, entry: Entry, checks: tuple[Check, ...], before: Kept | None) -> Kept:
    """What the narrow checks find in an entry, found anew only where an answer has changed."""
    project = view.workspace.project
    view.noted = None
    if (
        before is not None
        and before.project is project
        and before.entry.diagnostics is entry.diagnostics
        and all(_is_same(view.answer(question), answer) for question, answer in before.noted.items())
    ):
        return before
    noted: Noted = {}
    view.noted = noted
    found = tuple([diagnostic for each in checks if each in _NARROW for diagnostic in each(view, entry)])
    if any(change.place.path is not None for each in found for fix in each.fixes for change in fix.changes):
        noted["place", Kind.TREE, ""] = ()  # it moves without being asked for, so this holds once
    return Kept(entry, project, found, noted)


def _is_same(now: object, before: object) -> bool:
    return now is before or (not isinstance(now, Symbol) and now == before)


def _placed(diagnostic: Diagnostic, workspace: Workspace) -> Diagnostic:
    """The diagnostic with every place counted from the start of its file."""
    if not diagnostic.related and not any(change.place.anchor for fix in diagnostic.fixes for change in fix.changes):
        return diagnostic

    def resolve(place: Place) -> Place:
        if place.anchor is None or place.path is None:
            return place
        return Place(_absolute(workspace.files[place.path], place), place.path)

    return replace(
        diagnostic,
        related=tuple(Related(resolve(related.place), related.message) for related in diagnostic.related),
        fixes=tuple(
            Fix(fix.title, tuple(Change(resolve(change.place), change.text) for change in fix.changes), fix.safe)
            for fix in diagnostic.fixes
        ),
    )


def _absolute(file: File, place: Place) -> Span:
    return place.span.shifted(file.start_of(place.anchor))
