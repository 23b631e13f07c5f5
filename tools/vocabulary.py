"""The words of the language, as colouring grammars need them: taken from the tables that the parser and checks read.

One invariant: no word is written down here that a table of `btq_lang` has.  It does not know how any editor matches.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from btq_lang.catalog.engine_nodes import ENGINE_NODES
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.nodes import KNOWN_WORDS, spellings
from btq_lang.catalog.qualities import EDITIONS, qualities
from btq_lang.catalog.quality_words import ALIASES, AMBIGUOUS, PAPER_NAMES
from btq_lang.catalog.units import SYMBOLS as UNITS
from btq_lang.catalog.verbs import words
from btq_lang.grammar.claim_words import HAPPENINGS
from btq_lang.grammar.claim_words import VERB_WORDS as VERBS_OF_SUBJECTS
from btq_lang.grammar.clauses import ACTIONS, AVERAGE, EXPERIMENTS, METHODS, TIME
from btq_lang.grammar.conditions import COMPARISONS, FUNCTIONS, HEADS, METADATA_HEADS
from btq_lang.grammar.hazards import HAZARD_HEADS
from btq_lang.grammar.scenario_words import DURATIONS, ORDINALS, RESULTS, STEPS, TIMES, VERDICTS
from btq_lang.syntax.tokens import DIRECTIONS, NODE_CLAUSES, SYMBOLS

# Words that open an item of a file; what stands behind them differs, so each grammar treats them one by one.
ITEMS = (
    "BehaviorTree",
    "Root",
    "include",
    "signal",
    "context",
    "apply",
    "quality",
    "qualities",
    "QualityReq",
    "hazard",
    "scenario",
)
STEP_WORDS = STEPS  # `given` is an item too, so grammars know it by its line
BEHAVIOR_WORDS = (*RESULTS, *DURATIONS)
MODELS = "TreeNodesModel"

# The words inside clauses that no table of the parser lists, because a function of it reads each where it stands.
PARTICLES = (
    "at", "most", "least", "less", "more", "than", "between", "and", "to", "of",
    "per", "every", "within", "after", "with", "probability", "last", "violation", "by", "if",
    "assuming", "order", "else", "for", "sum", "under", "except", "node", "tagged", "from", "until", "each", "is",
    "occurrences",
)  # fmt: skip
SCENARIO_WORDS = (
    *(
        "of",
        "verifies",
        "every",
        "and",
        "writes",
        "then",
        "times",
        "not",
        "end",
        "have",
        "passed",
        "for",
        "the",
        "time",
    ),
    *("mission", "finally", "node", *RESULTS, *DURATIONS, *TIMES, *ORDINALS),
    *(word for verdict in VERDICTS for word in verdict),
)
SIGNAL_WORDS = ("from", "level", "counter", "gauge", "fresh", "within", "initially")
LOGIC = ("and", "or", "not")
TRUTH = ("true", "false")


def longest_first(words: Iterable[str]) -> tuple[str, ...]:
    """Sorted so that an alternation takes the longest: `Loop` does not hide `LoopDouble`."""
    return tuple(sorted(set(words), key=lambda word: (-len(word), word)))


def is_word(text: str) -> bool:
    """Whether it is a NAME and no symbol."""
    return re.fullmatch(r"[A-Za-z_][\w-]*", text) is not None


def _kinds(*categories: str) -> tuple[str, ...]:
    words = [word for kind in ENGINE_NODES if kind.category in categories for word in spellings(kind)]
    words += [word for word, known in KNOWN_WORDS.items() if known.category in categories]
    return longest_first(word for word in words if is_word(word))


# `Switch` is no spelling of one row: the number of children says which of Switch2 to Switch6 it is.
CONTROLS = longest_first((*_kinds("Control"), "Switch"))
DECORATORS = _kinds("Decorator")
LEAVES = longest_first(word for word in _kinds("Action", "Condition", "SubTree") if word not in CATEGORIES)
NODE_SYMBOLS = longest_first(SYMBOLS)
CATEGORY_WORDS = CATEGORIES
PORT_WORDS = longest_first(DIRECTIONS)
CLAUSE_WORDS = tuple(sorted(NODE_CLAUSES))
VERB_WORDS = longest_first(VERBS_OF_SUBJECTS)
ANSWERS = sorted(words(operands=("answer",)))
HEAD_WORDS = longest_first((*HEADS, *METADATA_HEADS, *HAZARD_HEADS))
REQUIREMENT_WORDS = longest_first(
    (*VERB_WORDS, *ANSWERS, *HEAD_WORDS, *HAPPENINGS, *EXPERIMENTS, TIME, AVERAGE, *PARTICLES)
)
OUTCOME_WORDS = longest_first((*ACTIONS, *METHODS))
STEP_CLAUSE_WORDS = longest_first((*SCENARIO_WORDS, *REQUIREMENT_WORDS))
FUNCTION_WORDS = longest_first(FUNCTIONS)
COMPARISON_SIGNS = longest_first(COMPARISONS)
UNIT_SYMBOLS = longest_first(UNITS)
EDITION_WORDS = tuple(EDITIONS)

# Each a tuple of words: how they are joined, with a blank, `-`, `_` or nothing, is the writer's choice.
QUALITY_NAMES = tuple(
    tuple(name.split("-"))
    for name in longest_first(
        part
        for edition in EDITIONS.values()
        for name in (
            *(quality.id for quality in qualities(edition)),
            *(word for words in ALIASES.values() for word in words.split()),
            *ALIASES,
            *AMBIGUOUS,
            *(word for pair in PAPER_NAMES for word in pair),
        )
        for part in name.split(".")
    )
)
