"""The checks: what is wrong with a file beyond its syntax.

One invariant: a check is a function of the view of an item.  It yields diagnostics whose spans count from that item,
and never raises.  A module holds the rules of one subject, and `CHECKS` maps types of items to functions.  A check gets
all it needs from its view, and so from the query store (workspace/queries.py), which caches results from one edit to
the next.  Checks do not know what an edit changed, nor how findings are printed.

    view.py, sorted_nodes.py   what a check sees: its item, and the nodes of a tree, sorted by what checks look for
    lookups.py, cpp_lookups.py   what only checks look up in the files and in C++, beside workspace/inputs.py
    kinds.py, names.py, ports.py, attributes.py, children.py, misplaced_children.py   what the engine would refuse
    known_ports.py, own_nodes.py   the ports of a node; nodes of a team with the name of one of Nav2
    trees.py, includes.py, elements.py, missing_ids.py, stale_models.py   likewise, of whole trees, models and files
    signs_in_nodes.py   likewise, on the line of a node
    positional.py, literals.py, port_values.py, scripts.py, strings.py   values, of ports too
    typed_numbers.py, passed_literals.py   values that a SubTree passes to the nodes below it
    entries.py, pointers.py, writers.py, misspelt.py, meant_entries.py, mixed_types.py   blackboard entries
    calls.py, flow.py, unset.py, arguments.py   entries across trees: read and never set, given and never read
    entry_effects.py   entries that a node seems to remove or to update
    engines.py, version3.py   which versions of the engine a file is for
    moving.py, target_changes.py   what another version of the engine or distribution of Nav2 changes
    statuses.py, results.py, unreachable.py, reactive.py, preconditions.py, resets.py   what nodes return, and traps
    nav2_nodes.py, nav2_literals.py, unread.py   nodes of Nav2: what they need and share, poses, goals, error codes
    requirements.py, clauses.py, qualifiers.py, bounds.py, qualities.py, prose.py, wording.py   requirements alone
    chain.py, approvals.py   hazards, and what requirements refine; approvals of an earlier meaning
    demanded.py, demands.py, budgets.py, limits.py, never_counted.py   at their nodes
    signals.py, renewals.py, enforcement.py   likewise, of what the engine is to enforce
    scenarios.py   what scenarios name, give and expect
    origins.py, placeholders.py   diagnostics shown on XML; classic placeholders
    suppressions.py, silencing.py   silenced rules
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeAlias

from btq_lang.checks import (
    approvals,
    arguments,
    attributes,
    bounds,
    chain,
    children,
    clauses,
    demands,
    elements,
    entry_effects,
    includes,
    kinds,
    literals,
    lookups,
    meant_entries,
    misspelt,
    mixed_types,
    moving,
    names,
    nav2_literals,
    nav2_nodes,
    passed_literals,
    placeholders,
    port_values,
    ports,
    preconditions,
    prose,
    qualifiers,
    qualities,
    reactive,
    requirements,
    resets,
    scenarios,
    scripts,
    stale_models,
    trees,
    typed_numbers,
    unreachable,
    unread,
    unset,
    version3,
)
from btq_lang.checks.engines import is_newer_than_engine
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.scan import line_start
from btq_lang.workspace import inputs
from btq_lang.workspace.config import configured
from btq_lang.workspace.findings import FileFindings, Reported
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

Check: TypeAlias = "Callable[[View], Iterator[Diagnostic]]"

_OF_PORTS: tuple[Check, ...] = (
    ports.duplicate_port,
    ports.misspelt_type,
    literals.invalid_literal,
)
_OF_MODELS: tuple[Check, ...] = (
    arguments.unread_port,
    elements.refused_element,
    elements.ignored_element,
    kinds.duplicate_definition,
    stale_models.stale_model,
    attributes.duplicate_attribute,
    *_OF_PORTS,
    literals.number_for_text,
    typed_numbers.default_of_another_type,
    names.forbidden_name,
    names.empty_text,
)
_OF_CLAUSES: tuple[Check, ...] = (
    requirements.requirement_without_text,
    clauses.duplicate_clause,
    clauses.clause_without_odds,
    clauses.odds_of_what,
    qualifiers.qualifier_of_all,
    clauses.unused_parameter,
    chain.unknown_hazard,
    chain.cyclic_refinement,
    approvals.approval_outdated,
    approvals.approval_missing,
    bounds.impossible_bound,
    bounds.span_outside_run,
    bounds.uses_of_gauge,
)
# The checks of each type of item: most items are small, and most checks do not concern most of them.
CHECKS: dict[type, tuple[Check, ...]] = {
    syntax.Include: (
        includes.missing_include,
        includes.cyclic_include,
        trees.duplicate_tree,
        kinds.duplicate_definition,
        requirements.conflicting_requirement,
        attributes.duplicate_attribute,
        moving.moving_include,
        elements.ignored_element,
    ),
    syntax.Verbatim: (elements.refused_element, elements.ignored_element),
    syntax.Root: (
        trees.unknown_tree,
        names.empty_text,
        attributes.duplicate_attribute,
        version3.version_3_file,
        elements.ignored_element,
    ),
    syntax.Tree: (
        trees.unknown_tree,
        trees.duplicate_tree,
        trees.recursive_tree,
        trees.unused_tree,
        trees.unknown_main_tree,
        trees.nothing_to_load,
        trees.tree_root_count,
        trees.nested_too_deep,
        trees.tree_named_like_node,
        elements.refused_element,
        kinds.unknown_node,
        kinds.no_models,
        kinds.not_an_engine_node,
        kinds.newer_engine_node,
        kinds.category_mismatch,
        kinds.clause_as_node,
        ports.unknown_port,
        ports.missing_port,
        attributes.unknown_attribute,
        attributes.duplicate_attribute,
        *_OF_PORTS,
        literals.old_entry,
        literals.json_in_braces,
        port_values.key_in_braces,
        literals.number_for_text,
        mixed_types.entry_with_two_types,
        typed_numbers.number_of_another_type,
        passed_literals.passed_literal,
        port_values.literal_for_output,
        port_values.count_of_nothing,
        children.child_count,
        children.switch_cases,
        children.parallel_threshold,
        names.forbidden_name,
        names.duplicate_instance_name,
        placeholders.classic_placeholder,
        placeholders.placeholder_clash,
        scripts.script_error,
        misspelt.misspelt_entry,
        meant_entries.meant_entry,
        unset.unset_entry,
        arguments.unread_argument,
        arguments.unread_port,
        requirements.unknown_requirement,
        requirements.conflicting_requirement,
        *_OF_CLAUSES,
        clauses.named_twice,
        names.empty_text,
        qualities.quality_name,
        prose.prose_constraint,
        reactive.reactive_multiple_async,
        reactive.explicit_in_reactive,
        reactive.condition_without_recheck,
        preconditions.one_shot_monitor,
        preconditions.while_skip_is_success,
        preconditions.skipped_condition,
        unreachable.unreachable_child,
        unread.tree_of_goal,
        nav2_nodes.isolated_node,
        nav2_nodes.shared_server,
        nav2_literals.wrong_number_of_fields,
        nav2_literals.percentage_for_share,
        resets.memory_lost,
        resets.last_success_lost,
        resets.stateful_condition,
        entry_effects.unset_without_effect,
        entry_effects.unnoticed_update,
        unread.default_instead,
        unread.error_code_not_collected,
        unread.foreign_error_code,
        moving.moving_on,
        requirements.unresolved,
    ),
    syntax.Model: _OF_MODELS,
    syntax.Models: _OF_MODELS,
    syntax.Signal: (
        kinds.duplicate_definition,
        names.empty_text,
        requirements.unused_word,
        requirements.unresolved,
    ),
    syntax.Context: (
        kinds.duplicate_definition,
        requirements.unused_word,
        requirements.unresolved,
    ),
    syntax.Requirement: (
        requirements.unknown_requirement,
        requirements.conflicting_requirement,
        requirements.unused_requirement,
        *_OF_CLAUSES,
        names.empty_text,
        qualities.quality_name,
        prose.prose_constraint,
        requirements.unresolved,
        requirements.requirement_without_subject,
    ),
    syntax.Hazard: (kinds.duplicate_definition, chain.shared_id, names.empty_text),
    syntax.Apply: (requirements.unknown_requirement, clauses.named_twice, requirements.unresolved),
    syntax.Given: (scenarios.ambiguous_given, scenarios.wrong_step),
    syntax.Scenario: (
        trees.unknown_tree,
        names.empty_text,
        scenarios.duplicate_title,
        scenarios.unknown_requirement,
        scenarios.expects_nothing,
        scenarios.undecidable_expectation,
        scenarios.ambiguous_given,
        scenarios.wrong_step,
    ),
    syntax.Qualities: (qualities.quality_name,),
    syntax.QualityDecl: (kinds.duplicate_definition, names.empty_text, qualities.quality_name),
}


# After these mistakes it is unknown which node is whose child, so their number is not checked.
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
        resets.memory_lost,
        resets.last_success_lost,
        resets.stateful_condition,
    )
)
# A file has many models: `_OF_PORTS` concern those with ports, and these checks those of trees with ports.
_OF_PORTS_OF_TREES: frozenset[Check] = frozenset((literals.number_for_text, names.forbidden_name))
_OF_NODES = tuple(rule for rule in CHECKS[syntax.Model] if rule not in _OF_PORTS_OF_TREES)
_WITHOUT_PORTS = tuple(rule for rule in _OF_NODES if rule not in _OF_PORTS)


def check(workspace: Workspace, path: str) -> tuple[Diagnostic, ...]:
    """All that is wrong with a file, in the order of its text.

        >>> from btq_lang import Workspace, check
        >>> workspace = Workspace.of({"main.btq": "BehaviorTree Main\\n    Sequnce\\n        Action Dock\\n"})
        >>> (diagnostic,) = check(workspace, "main.btq")
        >>> diagnostic.rule, diagnostic.fixes[0].title
        ('unknown-node', 'Replace `Sequnce` with `Sequence`')

    Args:
        path: one of the workspace's files.

    Returns:
        Diagnostics as the project configures them (severities, selection, suppressions); their spans count from the
        start of the file, and so do all their places.

    Raises:
        KeyError: the file does not exist.
    """
    (diagnostics,) = check_each(workspace, (path,))
    return diagnostics


def check_each(workspace: Workspace, paths: Iterable[str]) -> Iterator[tuple[Diagnostic, ...]]:
    """The same for many files, which share cached results."""
    store = Store(workspace)
    for path in paths:
        yield findings(store, path).diagnostics
        if workspace.factory is None:  # else other files need most of the same
            store.sweep()
    store.sweep(always=True)  # cached results refer to each other, and so to the workspace


def findings(store: Store[Workspace], path: str, of_logs: Iterable[Reported] = ()) -> FileFindings:
    """The same for a file of the store's workspace, with the diagnostics of each item.

    Args:
        of_logs: what logs show, which no check reads, as the project configures it.
    """
    # XML that cannot be read has no text, and so no items: their findings are kept until it can be read again.
    # The text of a C++ file is its models, but only what is wrong in the C++ itself is reported.
    file = store.state.files[path]
    reported = store.ask(reported_in_file, path, False) if file.text and not file.is_cpp else ()
    return findings_of(store.state, path, (*reported, *of_logs))


def findings_of(workspace: Workspace, path: str, reported: Iterable[Reported]) -> FileFindings:
    """The diagnostics of a file's items, without those that comments silence; those of XML are placed in the XML."""
    file_findings = FileFindings([(item, item.starts(workspace)) for item in reported])
    file = workspace.files[path]
    if not file.has_directives and not workspace.foreign:
        return file_findings
    diagnostics: Iterable[Diagnostic] = file_findings.diagnostics
    if file.has_directives:
        from btq_lang.checks.suppressions import Suppressions  # few files have any

        suppressions = Suppressions(file)
        diagnostics = [
            diagnostic for diagnostic in (*diagnostics, *suppressions.useless) if not suppressions.silence(diagnostic)
        ]
    if workspace.foreign:
        from btq_lang.checks.origins import shown_on_origins  # few workspaces have any

        diagnostics = shown_on_origins(workspace, path, diagnostics)
    return FileFindings.placed(configured(workspace.project, path, diagnostics))


def keep(workspace: Workspace, path: str) -> None:
    """Keep the results of a file from one edit to the next."""
    workspace.store.pin(reported_in_file, path, False)


def forget(workspace: Workspace, path: str) -> None:
    """Stop keeping the results of a file."""
    workspace.store.unpin(reported_in_file, path, False)
    workspace.store.sweep(always=True)


def let_go(workspace: Workspace) -> None:
    """Release what edits have replaced; called when nothing waits for the result."""
    workspace.store.sweep()


def reported_in_file(store: Store[Workspace], viewpoint: str, is_alone: bool) -> tuple[Reported, ...]:
    """The diagnostics of each item of a file that has any.

    Args:
        is_alone: leave out what is wrong in the files that it includes.
    """
    # Demands depend on all files in scope: an item to which they add no finding should not.  In a target they may add
    # other findings.
    demanded = store.ask(demands.demands_by_item, viewpoint)
    project = store.ask(inputs.project)
    has_target = project.moves_to is not None
    by_item = [
        store.ask(
            _reported,
            viewpoint,
            facts,
            is_alone and type(facts.item) is syntax.Include,
            has_target or id(facts.item) in demanded,
        )
        for facts in store.ask(lookups.items, viewpoint)
    ]
    wrong = tuple([reported for reported in by_item if reported is not None])
    if not wrong or not store.ask(is_newer_than_engine, viewpoint):
        return wrong
    signs = store.ask(lookups.signs, viewpoint) if not View(store, viewpoint).project.original_engines else None
    is_refused = version3.refuses([diagnostic for reported in wrong for diagnostic in reported.diagnostics], signs)
    return (_newer(store, viewpoint) if is_refused else ()) or wrong


def _newer(store: Store[Workspace], viewpoint: str) -> tuple[Reported, ...]:
    """The only finding of a file for version 4 that version 3 refuses; none if the project does not select it."""
    root = next((facts for facts in store.ask(lookups.items, viewpoint) if type(facts.item) is syntax.Root), None)
    if root is None:
        return ()
    view = View(store, viewpoint, root)
    selected = tuple(configured(view.project, viewpoint, (version3.version_4_file(view),)))
    return (Reported(selected, (viewpoint, root.item)),) if selected else ()


def _reported(
    store: Store[Workspace], viewpoint: str, facts: Facts, is_alone: bool, is_demanded: bool
) -> Reported | None:
    view = View(store, viewpoint, facts)
    entry = view.entry
    checks = (*checks_of(entry), demands.demands) if is_demanded else checks_of(entry)
    diagnostics: Iterable[Diagnostic] = [diagnostic for rule in checks for diagnostic in rule(view)]
    if view.project.moves_to is not None:
        from btq_lang.checks.target_changes import new_in_target  # few checks have a target

        diagnostics = [*diagnostics, *new_in_target(view, checks, [*diagnostics])]
    if type(facts.item) is syntax.Include and not is_alone:
        diagnostics = [*diagnostics, *includes.include_with_errors(view, _errors_in)]
    if entry.diagnostics:
        from btq_lang.checks.misplaced_children import reword_diagnostics  # few items have mistakes in their syntax
        from btq_lang.checks.positional import with_ports
        from btq_lang.checks.signs_in_nodes import without_signs

        reworded = without_signs(view, reword_diagnostics(view, entry.diagnostics))
        reported = meant_entries.with_entries(view, with_ports(view, reworded))
        diagnostics = (*reported, *_on_sound_lines(diagnostics, entry, view.text))
    elif not diagnostics:
        return None
    chosen = tuple(configured(view.project, viewpoint, trees.as_uncreated(view, diagnostics)))
    return Reported(chosen, (viewpoint, facts.item)) if chosen else None


def _errors_in(store: Store[Workspace], viewpoint: str) -> tuple[tuple[Place, str], ...]:
    """The errors that keep a file from being read, without what a check of its own would report; for XML, which no
    build writes and which is seldom checked itself, all errors."""
    view = View(store, viewpoint)
    if not view.is_xml:
        return view.ask(lookups.syntax_errors)
    diagnostics = findings_of(view.ask(inputs.everything), viewpoint, view.ask(reported_in_file, True)).diagnostics
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.effective_severity is Severity.ERROR]
    return tuple([(Place(diagnostic.span, viewpoint), diagnostic.message) for diagnostic in errors])


def checks_of(entry: syntax.Entry) -> tuple[Check, ...]:
    """The checks that may concern an entry."""
    item = entry.item
    checks = CHECKS.get(type(item), ())
    if type(item) is syntax.Model and not item.body:
        return _WITHOUT_PORTS
    if type(item) is syntax.Model and item.category.raw != "SubTree":
        return _OF_NODES
    if entry.diagnostics and any(problem.rule in _STRUCTURE_IS_LOST for problem in entry.diagnostics):
        checks = tuple(rule for rule in checks if rule not in _OF_STRUCTURE)
    return checks


def _on_sound_lines(diagnostics: Iterable[Diagnostic], entry: syntax.Entry, text: str) -> Iterator[Diagnostic]:
    """The diagnostics that are not on a line with a syntax error, whose meaning is unknown."""
    broken = {
        _line(text, diagnostic) for diagnostic in entry.diagnostics if diagnostic.effective_severity is Severity.ERROR
    }
    return (diagnostic for diagnostic in diagnostics if _line(text, diagnostic) not in broken)


def _line(text: str, diagnostic: Diagnostic) -> int:
    return line_start(text, 0, diagnostic.span.start)
