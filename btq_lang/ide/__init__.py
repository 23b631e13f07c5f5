"""Editor features: functions of `(workspace, path, offset, …)` that return frozen data, one module a feature.

One invariant: a feature is a pure function that works for every text and every offset; without a result it returns None
or (). Offsets are Python indices; nothing here knows editors, the protocol or lines.

Features that the server calls are imported at their first call: an editor waits for the server to start, and importing
all features and the checks that they use takes a third of that time.

    place.py, meaning.py   where the cursor is, and what the word there means: the features below use these two
    completion.py          with completion_list, proposals, node_proposals, clause_words, measures, snippets and ports;
                           scenario_words and scenario_proposals in scenarios
    xml_completion.py      the same in XML, of the same proposals
    hover.py               with describe and clause_enforcement; the ports of a node while it is typed
    external.py            the requirements of other tools, for completion, hover and links
    navigation.py          from a name to its definition, its uses and its callers
    rename.py, moves.py    edits in every file that names a thing
    actions.py             with refactor, block, short_form and unused
    on_type.py, structure.py, outline.py, hints.py   edits while typing, folding, outline, inlay hints and lenses
    outlook.py             how likely trees succeed, with the skills that btq.toml declares, for lenses and hover
    verdicts.py            what logs show of requirements, for lenses, hover and diagnostics
    scenarios.py           which scenarios there are
    violations.py          which requirements can be asked whether they can be violated
    runs.py                which runs an editor may show, and a run on the picture of a text
    colours.py             semantic tokens, with stretches, appearance and legend; xml_colours: of scripts in XML
    readiness.py           computes results before they are requested
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.ide import actions as actions
    from btq_lang.ide import colours as colours
    from btq_lang.ide import completion as completion
    from btq_lang.ide import describe as describe
    from btq_lang.ide import hints as hints
    from btq_lang.ide import hover as hover
    from btq_lang.ide import moves as moves
    from btq_lang.ide import navigation as navigation
    from btq_lang.ide import on_type as on_type
    from btq_lang.ide import outline as outline
    from btq_lang.ide import readiness as readiness
    from btq_lang.ide import rename as rename
    from btq_lang.ide import scenarios as scenarios
    from btq_lang.ide import structure as structure
    from btq_lang.ide import violations as violations
    from btq_lang.ide import xml_colours as xml_colours


def __getattr__(name: str) -> object:
    from importlib import import_module

    try:
        return import_module(f"{__name__}.{name}")
    except ModuleNotFoundError as error:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}") from error
