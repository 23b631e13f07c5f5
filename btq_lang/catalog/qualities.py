"""Looking up quality names: what a QualityPath means in an edition of ISO/IEC 25010.

One invariant: a name written as a canonical id of the edition is exact and nothing else is proposed for it, and
whatever is proposed is itself exact.  It does not know the qualities that a file declares: callers look there first.

Names compare after folding case, blanks, `-`, `_` and British or American spelling.  What counts as exact: the id of a
characteristic or of a robotics quality; characteristic and sub-characteristic; a sub-characteristic alone, if it is the
only one in the edition and the word has no other meaning; and the pairs of the published paper.  All else that is
understood is an alias (of the whole name or its front), another edition's name, or ambiguous.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache, lru_cache
from typing import Final, Literal, TypeAlias

from btq_lang.catalog.quality_model import AI, MODELS, NAMES, NO_EQUAL, ROBOTICS, SUCCESSORS
from btq_lang.catalog.quality_words import ALIASES, AMBIGUOUS, PAPER_NAMES
from btq_lang.util.record import Record
from btq_lang.util.spelling import near

Edition: TypeAlias = "Literal['2011', '2023']"

# By the word after `qualities` in a file.
EDITIONS: Final[dict[str, Edition]] = {"iso25010-2023": "2023", "iso25010-2011": "2011"}
DEFAULT_EDITION: Final[Edition] = "2023"


class Quality(Record):
    """A quality.

    Attributes:
        id: canonical: `performance-efficiency.time-behaviour`.
        name: as the standard prints it.
        parent: the id of the characteristic it is part of.
        kind: product or in-use: of the ISO's models; robotics: an addition; ai: of ISO/IEC 25059.
        nearest: of a robotics quality, the nearest one of the 2023 edition.
        measures: of a robotics quality, what to measure, in words.
    """

    id: str
    name: str
    definition: str
    parent: str | None
    kind: Literal["product", "in-use", "robotics", "ai"]
    source: str
    nearest: str | None = None
    measures: str = ""


class QualityMatch(Record):
    """The meaning of a QualityPath.

    Attributes:
        kind: exact; alias: another word for it; other-edition: a name of another edition; ambiguous; unknown.
        quality: the quality that is meant, if it is unique; a name of another edition without an equal in this one
            means the other edition's.
        candidates: what to write instead, the likeliest first; empty for an exact or an unknown name.
        safe: whether the only candidate is the quality that is meant, so that replacing the name keeps the meaning.
        explanation: why, or what to know about the word, for a reader; may be empty.
        near: of an unknown name, ids that look like it.
    """

    kind: Literal["exact", "alias", "other-edition", "ambiguous", "unknown"]
    quality: Quality | None = None
    candidates: tuple[Quality, ...] = ()
    safe: bool = False
    explanation: str = ""
    near: tuple[str, ...] = ()


@lru_cache(1000)
def find(words: tuple[str, ...], edition: Edition = DEFAULT_EDITION) -> QualityMatch:
    """The meaning of the parts of a QualityPath in an edition.

    Args:
        words: the path's names as written: `("performance", "time-behavior")`, `("time-behaviour",)`.
    """
    index = _index(edition)
    keys = tuple(fold(word) for word in words)
    if not words:
        return QualityMatch("unknown")
    exact = index.by_key.get(".".join(keys))
    if exact is not None:
        return QualityMatch("exact", exact, explanation=_remark(keys))
    if keys in _PAPER_NAMES:
        return QualityMatch("exact", get(_PAPER_NAMES[keys], edition))
    match = _find_word(words[0], keys[0], index) if len(words) == 1 else _find_path(words, keys, index)
    return match or QualityMatch("unknown", near=_similar_ids(words, keys, index))


def get(id_: str, edition: Edition = DEFAULT_EDITION) -> Quality | None:
    """The quality of a canonical id, if the edition has it."""
    return _index(edition).by_id.get(id_)


def qualities(edition: Edition = DEFAULT_EDITION) -> tuple[Quality, ...]:
    """All qualities of an edition: the product's, those in use, robotics', then ISO/IEC 25059's."""
    return tuple(_index(edition).by_id.values())


def siblings(quality: Quality, edition: Edition = DEFAULT_EDITION) -> tuple[Quality, ...]:
    """The other qualities beside one: under the same characteristic, or the other characteristics of its kind."""
    return tuple(
        other
        for other in qualities(edition)
        if other.id != quality.id and other.parent == quality.parent and (other.parent or other.kind == quality.kind)
    )


def parts(id_: str, edition: Edition = DEFAULT_EDITION) -> tuple[Quality, ...]:
    """The sub-characteristics of a characteristic."""
    return tuple(quality for quality in qualities(edition) if quality.parent == id_)


def successors(id_: str) -> tuple[str, ...]:
    """The names of 2023 for a name of 2011; empty if it was dropped, or 2011 does not have the name.

    A sub-characteristic that has no successor of its own has those of its characteristic.
    """
    if get(id_, "2011") is None:
        return ()
    if id_ in SUCCESSORS:
        return SUCCESSORS[id_]
    if get(id_, "2023") is not None:
        return (id_,)
    return SUCCESSORS.get(id_.partition(".")[0], ())


def predecessors(id_: str) -> tuple[str, ...]:
    """The names of 2011 for a name of 2023; empty if it is new."""
    if get(id_, "2011") is not None and id_ not in SUCCESSORS:
        return (id_,)
    return tuple(old for old, new in SUCCESSORS.items() if id_ in new)


def fold(word: str) -> str:
    """The form in which names are compared: the same for `Time Behavior`, `time_behaviour` and `time-behaviour`."""
    return _american(word.casefold().translate(_BLANKS))


def _find_word(word: str, key: str, index: _Index) -> QualityMatch | None:
    """The match of a single word that is not an id."""
    _, meanings = AMBIGUOUS.get(key, ("", ()))
    meant = tuple(index.by_id[id_] for id_ in meanings if id_ in index.by_id)
    if len(meant) > 1:
        return QualityMatch("ambiguous", None, meant, explanation=_remark((key,)))
    part = index.by_part.get(key)
    if part is not None:
        return QualityMatch("exact", part, explanation=_remark((key,)))
    if meant:
        return QualityMatch("alias", meant[0], meant, True, _remark((key,)))
    other = _index("2011" if index.edition == "2023" else "2023")
    old = other.by_key.get(key) or other.by_part.get(key)
    if old is not None:
        return _of_other_edition(old, index)
    if key in _ALIASES:
        return _alias(word, _ALIASES[key], index)
    additions = index.by_addition.get(key, ())
    return QualityMatch("exact", additions[0]) if len(additions) == 1 else None


def _find_path(words: tuple[str, ...], keys: tuple[str, ...], index: _Index) -> QualityMatch | None:
    """The match of several words that are not an id, if the last word names a part of what the others name."""
    other = _index("2011" if index.edition == "2023" else "2023")
    old = other.by_key.get(".".join(keys))
    if old is not None:
        return _of_other_edition(old, index)
    front = {quality.id for quality in _meanings(find(words[:-1], index.edition))}
    inside = [index.by_key.get(f"{fold(id_)}.{keys[-1]}") for id_ in front if "." not in id_]
    last = _meanings(find(words[-1:], index.edition))
    matches = tuple(
        dict.fromkeys([part for part in inside if part] or [one for one in last if _belongs(one, front, index)])
    )
    if not matches:
        return None
    if len(matches) > 1:
        return QualityMatch("ambiguous", None, matches, explanation=f"`{'.'.join(words)}` may mean each of these")
    return QualityMatch("alias", matches[0], matches, True, f"`{'.'.join(words)}` is another word for {matches[0].id}")


def _belongs(quality: Quality, front: set[str], index: _Index) -> bool:
    """Whether a quality belongs under one of these ids.  A robotics quality belongs under the nearest to it."""
    if quality.parent is not None:
        return quality.parent in front
    nearest = _in_edition(quality.nearest, index) if quality.nearest is not None else ()
    return any(id_ in front or id_.partition(".")[0] in front for id_ in nearest)


def _meanings(match: QualityMatch) -> tuple[Quality, ...]:
    return match.candidates or (() if match.quality is None else (match.quality,))


def _of_other_edition(old: Quality, index: _Index) -> QualityMatch:
    candidates = tuple(index.by_id[id_] for id_ in _in_edition(old.id, index))
    now = " or ".join(quality.id for quality in candidates)
    same = len(candidates) == 1 and _are_equal(old.id, candidates[0].id)
    where, verb = ("a name of", "is") if index.edition == "2023" else ("new in", "was")
    counterpart = f"in {index.edition} it {verb} {'' if same else 'nearest to '}{now}"
    explanation = f"`{old.id}` is {where} {old.source}; {counterpart if now else f'{index.edition} has no counterpart'}"
    return QualityMatch("other-edition", candidates[0] if same else old, candidates, same, explanation)


def _are_equal(id_: str, other: str) -> bool:
    """Whether a name of 2011 and one of 2023, in either order, name the same quality."""
    old, new = (id_, other) if get(id_, "2011") is not None else (other, id_)
    return old not in NO_EQUAL and successors(old) == (new,) and predecessors(new) == (old,)


def _alias(word: str, id_: str, index: _Index) -> QualityMatch:
    """Aliases lead to ids of 2023, which may be another in 2011, or none."""
    ids = _in_edition(id_, index)
    if not ids:
        new = _index("2023").by_id[id_]
        return QualityMatch("other-edition", new, explanation=f"`{word}` means {id_}, which is new in {new.source}")
    quality = index.by_id[ids[0]]
    return QualityMatch("alias", quality, (quality,), True, f"`{word}` is another word for {quality.id}")


def _in_edition(id_: str, index: _Index) -> tuple[str, ...]:
    """The ids in the index's edition for an id of either edition."""
    if id_ in index.by_id:
        return (id_,)
    return successors(id_) if index.edition == "2023" else predecessors(id_)


def _remark(keys: tuple[str, ...]) -> str:
    return AMBIGUOUS[keys[0]][0] if len(keys) == 1 and keys[0] in AMBIGUOUS else ""


def _similar_ids(words: tuple[str, ...], keys: tuple[str, ...], index: _Index) -> tuple[str, ...]:
    """Ids for an unknown name: what its last word means, or else those similar to the whole name or its last word."""
    last = [quality.id for quality in _meanings(find(words[-1:], index.edition))] if len(words) > 1 else []
    names: dict[str, tuple[str, ...]] = {}
    names |= {key: (quality.id,) for key, quality in (*index.by_key.items(), *index.by_part.items())}
    names |= {key: tuple(quality.id for quality in named) for key, named in index.by_addition.items()}
    names |= {key: _in_edition(id_, index) for key, id_ in _ALIASES.items()}
    looks = near(".".join(keys), names) or near(keys[-1], names)
    ids = [*last, *(id_ for key in looks for id_ in names[key])]
    return tuple(dict.fromkeys(id_ for id_ in ids if id_ in index.by_id))[:3]


class _Index:
    """The qualities of an edition, by id and by folded names.

    Attributes:
        by_key: folded ids.
        by_part: folded names of the ISO's sub-characteristics, without the characteristic: each is unique.
        by_addition: the same for ISO/IEC 25059, where some are not.
    """

    def __init__(self, edition: Edition) -> None:
        self.edition: Final = edition
        self.by_id: Final = {quality.id: quality for quality in _of_edition(edition)}
        # Ids are lower case and ASCII, so half of fold() is enough.
        self.by_key: Final = {_american(id_.replace("-", "")): quality for id_, quality in self.by_id.items()}
        self.by_part: Final[dict[str, Quality]] = {}
        self.by_addition: Final[dict[str, tuple[Quality, ...]]] = {}
        for key, quality in self.by_key.items():
            part = key.partition(".")[2]
            if quality.kind == "ai":
                self.by_addition[part] = (*self.by_addition.get(part, ()), quality)
            elif part:
                self.by_part[part] = quality


def _of_edition(edition: Edition) -> Iterable[Quality]:
    for its, kind, source, model in MODELS:
        for id_, definition, below in _rows(model) if its == edition else ():
            yield Quality(id_, _name(id_), definition, None, kind, source)
            for part, part_definition in below:
                yield Quality(f"{id_}.{part}", _name(part), part_definition, id_, kind, source)
    for id_, definition, ((nearest, measures),) in _rows(ROBOTICS):
        name = id_.replace("-", " ")
        yield Quality(id_, name, definition, None, "robotics", "robotics practice", nearest, measures)
    for parent, _, below in _rows(AI):
        for part, definition in below:
            yield Quality(f"{parent}.{part}", _name(part), definition, parent, "ai", "ISO/IEC 25059:2023")


def _rows(outline: str) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """The lines of an outline, in two at their first `:`, each with those that are indented below it."""
    rows: list[tuple[str, str, list[tuple[str, str]]]] = []
    for line in outline.splitlines():
        name, _, text = line.partition(":")
        definition = " ".join(text.split())
        if name.startswith(" "):
            rows[-1][2].append((name.strip(), definition))
        else:
            rows.append((name, definition, []))
    return rows


def _name(id_: str) -> str:
    return NAMES.get(id_) or id_.replace("-", " ").capitalize()


def _american(key: str) -> str:
    for british, american in _SPELLINGS:
        key = key.replace(british, american)
    return key


@cache
def _index(edition: Edition) -> _Index:
    """An edition's index, made on demand: most files need one edition, many none."""
    return _Index(edition)


_BLANKS: Final = dict.fromkeys(map(ord, "-_ \t\r\n"))
_SPELLINGS: Final = (
    ("behaviour", "behavior"),
    ("isation", "ization"),
    ("isability", "izability"),
    ("analys", "analyz"),
)
# The words of these tables are folded already, except for the `-` that makes them readable.
_PAPER_NAMES: Final = {tuple(name.replace("-", "") for name in names): id_ for names, id_ in PAPER_NAMES.items()}
_ALIASES: Final = {word: id_ for id_, words in ALIASES.items() for word in words.replace("-", "").split()}
