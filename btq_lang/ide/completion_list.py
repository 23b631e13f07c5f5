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
    begun = _begun_labels(proposals)
    is_word = any(proposal.label == typed and proposal.kind != "snippet" for proposal in proposals)
    if is_word and not asked and typed.lower() not in begun:
        return ()
    order: list[tuple[int, int, int]] = []  # each precedes all labels that begin with one of its words
    for place, proposal in enumerate(proposals):
        order.append((min(place, begun.get(proposal.label.lower(), place)), len(proposal.label), place))
    ordered = [proposals[place] for _, _, place in sorted(order)]
    contained = _contained_labels(proposals, typed.lower())
    return tuple(
        [
            entry
            for proposal in ordered
            for entry in _entries(proposal, typed, asked, proposal.label.lower() in contained)
        ]
    )


def _entries(proposal: Proposal, typed: str, asked: bool, is_contained: bool) -> Iterator[Proposal]:
    """The entries of one proposal: none, the proposal, or also its bare word, if an editor finds the word in another
    one."""
    if proposal.kind in ("keyword", "snippet") and proposal.label[:1].islower() and typed[:1].isupper():
        return  # editors ignore case; a name that is not a keyword begins here
    if proposal.kind == "snippet":
        yield proposal
        return
    is_typed = proposal.label == typed
    if not is_typed and not is_contained:
        yield replace(proposal, filter=_shortened(proposal, typed))
        return
    if proposal.snippet is None and proposal.insert.strip() == proposal.label:
        yield proposal
        return
    bare = replace(proposal, insert=proposal.label, snippet=None)
    full = replace(proposal, label=f"{proposal.label} …", filter=proposal.filter or proposal.label)
    if not is_typed:
        yield replace(full, filter=_shortened(proposal, typed))
    yield bare
    if is_typed and asked:
        yield full


def _shortened(proposal: Proposal, typed: str) -> str:
    """What the typed letters are compared with: the label, or each word of the filter, without the last letter unless
    it is typed already."""
    words = proposal.filter.split(" ") if proposal.filter else [proposal.label]
    return " ".join([word if word == typed else word[:-1] or word for word in words])


def _contained_labels(proposals: Sequence[Proposal], typed: str) -> set[str]:
    """The labels that continue the typed letters and that an editor finds in the text of another proposal: it looks for
    their letters in this order, the first one at the start of a word.  All labels of a long list, where comparing each
    with each takes long."""
    if len(proposals) > _MANY:
        return {proposal.label.lower() for proposal in proposals}
    texts = [f"{proposal.label} {proposal.filter}" for proposal in proposals]
    lowered = [(place, text.lower()) for place, text in enumerate(texts)]
    by_initial: dict[str, list[tuple[int, str]]] = {}
    for (place, text), written in zip(lowered, texts, strict=True):
        for initial in {letter.lower() for letter in _INITIAL.findall(written)}:
            by_initial.setdefault(initial, []).append((place, text))
    contained: set[str] = set()
    for place, proposal in enumerate(proposals):
        label = proposal.label.lower()
        if label.startswith(typed) and any(
            other != place and _holds(text, label) for other, text in by_initial.get(label[:1], ())
        ):
            contained.add(label)
    return contained


def _holds(text: str, letters: str) -> bool:
    """Whether a text has these letters in this order."""
    offset = 0
    for letter in letters:
        offset = text.find(letter, offset) + 1
        if not offset:
            return False
    return True


def _begun_labels(proposals: Sequence[Proposal]) -> Mapping[str, int]:
    """The labels that words of other proposals begin with, ignoring case, each with the first index of such a
    proposal."""
    labels = {proposal.label.lower(): place for place, proposal in reversed([*enumerate(proposals)])}
    earliest: dict[str, int] = {}
    beginnings: list[str] = []  # of the current word, each a prefix of the next
    for word, place in sorted([(word, place) for place, proposal in enumerate(proposals) for word in _words(proposal)]):
        while beginnings and not word.startswith(beginnings[-1]):
            beginnings.pop()
        for label in beginnings:
            if labels[label] != place:
                earliest[label] = min(earliest.get(label, place), place)
        if word in labels and word not in beginnings[-1:]:
            beginnings.append(word)
            if labels[word] != place:
                earliest[word] = min(earliest.get(word, place), place)
    return earliest


def _words(proposal: Proposal) -> list[str]:
    """What an editor may compare the typed letters with; it ignores case."""
    return [proposal.label.lower(), *(proposal.filter.lower().split(" ") if proposal.filter else ())]


_INITIAL = re.compile(r"(?:(?<![^\W_])|(?<=[^\W_])(?=[A-Z]))\S")  # the first letter of a word, or a capital inside one
_MANY = 200  # all of the engine's nodes, all units, and as many names of a project again
