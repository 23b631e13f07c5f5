"""Editor features: functions of `(workspace, path, offset, …)` that return frozen data, one module a feature.

One invariant: a feature is a pure function that works for every text and every offset; without a result it returns None
or (). Offsets are Python indices; nothing here knows editors, the protocol or lines.

Features that the server calls are imported at their first call: an editor waits for the server to start, and importing
all features and the checks that they use takes a third of that time.

    place.py, meaning.py   where the cursor is, and what the word there means: the features below use these two
    completion.py          with completion_list, proposals, node_proposals, clause_words, measures, snippets,
                           ports, documentation
    xml_completion.py      the same in XML, of the same proposals
    hover.py, signature.py   with describe, clause_enforcement and built_xml
    navigation.py, relations.py, calls.py, node_path.py   from a name to its definition, its uses and its callers
    rename.py, moves.py    edits in every file that names a thing
    actions.py             with refactor, block, short_form and unused
    on_type.py, structure.py, outline.py, hints.py   edits while typing, folding, outline, inlay hints and lenses
    verdicts.py            what logs show of requirements, for lenses, hover and diagnostics
    semantic_tokens.py     with colours, stretches, appearance and legend; xml_colours: the same of scripts in XML
    readiness.py           computes results before they are requested
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.ide.actions import code_actions
    from btq_lang.ide.calls import Call, TreeItem, called, callers, prepare_calls
    from btq_lang.ide.colours import Colours, colours, delta, making
    from btq_lang.ide.completion import complete
    from btq_lang.ide.documentation import documentation as documented
    from btq_lang.ide.documentation import include_edits
    from btq_lang.ide.hints import code_lenses, inlay_hints
    from btq_lang.ide.hover import hover as explain
    from btq_lang.ide.moves import moved_files
    from btq_lang.ide.navigation import Target, find_references, goto_definition, highlights
    from btq_lang.ide.node_path import node_path as path_of_node
    from btq_lang.ide.on_type import linked_ranges
    from btq_lang.ide.on_type import on_type as typed
    from btq_lang.ide.outline import document_symbols, workspace_symbols
    from btq_lang.ide.readiness import getting_ready
    from btq_lang.ide.relations import goto_implementation, goto_type
    from btq_lang.ide.rename import Refusal, prepare_rename
    from btq_lang.ide.rename import rename as renamed
    from btq_lang.ide.semantic_tokens import encoded_within
    from btq_lang.ide.signature import signature_help
    from btq_lang.ide.structure import document_links, folding_ranges, selection_range
    from btq_lang.ide.xml_colours import colours_in_xml, encoded_in_xml

__all__ = [
    "Call",
    "Colours",
    "Refusal",
    "Target",
    "TreeItem",
    "called",
    "callers",
    "code_actions",
    "code_lenses",
    "colours",
    "colours_in_xml",
    "complete",
    "delta",
    "document_links",
    "document_symbols",
    "documented",
    "encoded_in_xml",
    "encoded_within",
    "explain",
    "find_references",
    "folding_ranges",
    "getting_ready",
    "goto_definition",
    "goto_implementation",
    "goto_type",
    "highlights",
    "include_edits",
    "inlay_hints",
    "linked_ranges",
    "making",
    "moved_files",
    "path_of_node",
    "prepare_calls",
    "prepare_rename",
    "renamed",
    "selection_range",
    "signature_help",
    "typed",
    "workspace_symbols",
]

_HOMES = {
    "actions": ("code_actions",),
    "calls": ("Call", "TreeItem", "called", "callers", "prepare_calls"),
    "colours": ("Colours", "colours", "delta", "making"),
    "completion": ("complete",),
    "documentation": ("documented", "include_edits"),
    "hints": ("code_lenses", "inlay_hints"),
    "hover": ("explain",),
    "moves": ("moved_files",),
    "navigation": ("Target", "find_references", "goto_definition", "highlights"),
    "node_path": ("path_of_node",),
    "on_type": ("linked_ranges", "typed"),
    "outline": ("document_symbols", "workspace_symbols"),
    "readiness": ("getting_ready",),
    "relations": ("goto_implementation", "goto_type"),
    "rename": ("Refusal", "prepare_rename", "renamed"),
    "semantic_tokens": ("encoded_within",),
    "signature": ("signature_help",),
    "structure": ("document_links", "folding_ranges", "selection_range"),
    "xml_colours": ("colours_in_xml", "encoded_in_xml"),
}
# A module of this package has the function's own name.
_CALLED = {
    "documented": "documentation",
    "explain": "hover",
    "path_of_node": "node_path",
    "renamed": "rename",
    "typed": "on_type",
}


def __getattr__(name: str) -> object:
    from importlib import import_module

    home = next((home for home, names in _HOMES.items() if name in names), None)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{home}")
    # All of them: importing a module that has the name of its function binds that name to the module.
    globals().update({each: getattr(module, _CALLED.get(each, each)) for each in _HOMES[home]})
    found: object = globals()[name]
    return found
