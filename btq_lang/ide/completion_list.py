"""The list of a completion, as an editor narrows it with every letter and takes its first entry at Enter.

One invariant: Enter after a complete word is a line break.  A word leaves the list when its last letter is typed, and
the list closes when it is empty.  A word that an editor still finds in another one, `string` in `std::vector<string>`,
stays first and as it is typed, so that accepting it changes nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from btq_lang.ide.proposals import Proposal
from btq_lang.util.record import replace


def listed(proposals: Sequence[Proposal], typed: str, asked: bool) -> tuple[Proposal, ...]:
    """The entries of the list, best first.  A list that the user does not request never opens at a complete word."""
    begun = _begun(proposals)
    is_word = any(one.label == typed and one.kind != "snippet" for one in proposals)
    if is_word and not asked and typed.lower() not in begun:
        return ()
    order: list[tuple[int, int, int]] = []  # each precedes all labels that begin with one of its words
    for place, one in enumerate(proposals):
        order.append((min(place, begun.get(one.label.lower(), place)), len(one.label), place))
    ordered = [proposals[place] for _, _, place in sorted(order)]
    found_in = _found_in(proposals, typed.lower())
    return tuple([each for one in ordered for each in _entries(one, typed, asked, one.label.lower() in found_in)])


def _entries(one: Proposal, typed: str, asked: bool, is_found: bool) -> Iterator[Proposal]:
    """The entries of one proposal: none, the proposal, or also its bare word, if an editor finds the word in another
    one."""
    if one.kind in ("keyword", "snippet") and one.label[:1].islower() and typed[:1].isupper():
        return  # editors ignore case; a name that is not a keyword begins here
    if one.kind == "snippet":
        yield one
        return
    is_typed = one.label == typed
    if not is_typed and not is_found:
        yield replace(one, filter=_shortened(one, typed))
        return
    if one.snippet is None and one.insert.strip() == one.label:
        yield one
        return
    bare = replace(one, insert=one.label, snippet=None)
    full = replace(one, label=f"{one.label} …", filter=one.filter or one.label)
    if not is_typed:
        yield replace(full, filter=_shortened(one, typed))
    yield bare
    if is_typed and asked:
        yield full


def _shortened(one: Proposal, typed: str) -> str:
    """What the typed letters are compared with: the label, or each word of the filter, without the last letter unless
    it is typed already."""
    words = one.filter.split(" ") if one.filter else [one.label]
    return " ".join([word if word == typed else word[:-1] or word for word in words])


def _found_in(proposals: Sequence[Proposal], typed: str) -> set[str]:
    """The labels that continue the typed letters and that an editor finds in the text of another proposal: it looks for
    their letters in this order, the first one at the start of a word.  All labels of a long list, where comparing each
    with each takes long."""
    if len(proposals) > _MANY:
        return {one.label.lower() for one in proposals}
    texts = [f"{one.label} {one.filter}" for one in proposals]
    lowered = [(place, text.lower()) for place, text in enumerate(texts)]
    by_initial: dict[str, list[tuple[int, str]]] = {}
    for (place, text), written in zip(lowered, texts, strict=True):
        for initial in {found.lower() for found in _INITIAL.findall(written)}:
            by_initial.setdefault(initial, []).append((place, text))
    found: set[str] = set()
    for place, one in enumerate(proposals):
        label = one.label.lower()
        if label.startswith(typed) and any(
            other != place and _holds(text, label) for other, text in by_initial.get(label[:1], ())
        ):
            found.add(label)
    return found


def _holds(text: str, letters: str) -> bool:
    """Whether a text has these letters in this order."""
    at = 0
    for letter in letters:
        at = text.find(letter, at) + 1
        if not at:
            return False
    return True


def _begun(proposals: Sequence[Proposal]) -> Mapping[str, int]:
    """The labels that words of other proposals begin with, ignoring case, each with the first index of such a
    proposal."""
    labels = {one.label.lower(): place for place, one in reversed([*enumerate(proposals)])}
    found: dict[str, int] = {}
    beginnings: list[str] = []  # of the current word, each a prefix of the next
    for word, place in sorted([(word, place) for place, one in enumerate(proposals) for word in _words(one)]):
        while beginnings and not word.startswith(beginnings[-1]):
            beginnings.pop()
        for label in beginnings:
            if labels[label] != place:
                found[label] = min(found.get(label, place), place)
        if word in labels and word not in beginnings[-1:]:
            beginnings.append(word)
            if labels[word] != place:
                found[word] = min(found.get(word, place), place)
    return found


def _words(one: Proposal) -> list[str]:
    """What an editor may compare the typed letters with; it ignores case."""
    return [one.label.lower(), *(one.filter.lower().split(" ") if one.filter else ())]


_INITIAL = re.compile(r"(?:(?<![^\W_])|(?<=[^\W_])(?=[A-Z]))\S")  # the first letter of a word, or a capital inside one
_MANY = 200  # all of the engine's nodes, all units, and as many names of a project again
