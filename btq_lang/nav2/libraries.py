"""Libraries of nodes that bt_navigator loads: which, and what is wrong with those that parameters name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.nav2.libraries import LIBRARIES
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.nav2.parameters import Parameters, Text
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span

NAMES: Final = "plugin_lib_names"


class Libraries:
    """The libraries that bt_navigator loads in a distribution.

    Attributes:
        nodes: that Nav2's own libraries among them register.
        are_all_known: whether there are no others.
    """

    def __init__(self, parameters: Parameters, distribution: str) -> None:
        self._letter = distribution[0]
        self._shown = distribution.capitalize()
        self._named = parameters.texts(NAMES)
        own = {name for name, (_, _, loaded) in LIBRARIES.items() if self._letter in loaded}
        self._built_in = own if self._named is None or self._letter not in _REPLACING else set()
        loaded = self._built_in | {each.text for each in self._named or ()}
        self.nodes = frozenset(node for name in loaded if self._exists(name) for node in LIBRARIES[name][0])
        self.are_all_known = all(self._exists(each.text) for each in self._named or ())

    def library_of(self, node: str) -> str | None:
        """The library of Nav2 in this distribution that registers a node."""
        return next((name for name, (nodes, _, _) in LIBRARIES.items() if node in nodes and self._exists(name)), None)

    def findings(self) -> Iterator[Diagnostic]:
        """What is wrong with the libraries that the parameters name."""
        named = self._named or ()
        yield from self._loaded_by_nav2([each for each in named if each.text in self._built_in])
        first: dict[str, Span] = {}
        for each in named:
            if each.text in first and each.text not in self._built_in:
                related = (Related(Place(first[each.text]), "first one"),)
                message = f"`{each.text}` is named twice, so its nodes are registered twice"
                yield Diagnostic("library-loaded-twice", each.span, message, related, (_REFUSED,))
            elif not self._exists(each.text) and (meant := self._meant(each.text)) is not None:
                message = f"Nav2 has no library `{each.text}` in {self._shown}{meant}"
                yield Diagnostic("unknown-library", each.span, message, notes=(_REFUSED,))
            first.setdefault(each.text, each.span)

    def _loaded_by_nav2(self, named: list[Text]) -> Iterator[Diagnostic]:
        """The libraries that Nav2 loads without a name: one finding, as a file of another distribution names all."""
        if not named:
            return
        first, *others = named
        more = f" and {len(others)} more of the named libraries" if others else ""
        message = f"Nav2 loads `{first.text}`{more} by itself in {self._shown}, so nodes are registered twice"
        related = tuple(Related(Place(each.span), "this one too") for each in others[:_SHOWN])
        yield Diagnostic("library-loaded-twice", first.span, message, related, (_REFUSED,))

    def _meant(self, name: str) -> str | None:
        """What a library that is not Nav2's in this distribution may mean, for a message; None: it is a team's own."""
        here = [each for each in LIBRARIES if self._exists(each)]
        if name in LIBRARIES and name.startswith(_BESIDE):
            return None
        if name not in LIBRARIES:
            likely = [each for each in here if distance(name, each, 1) <= 1]  # own ones are often named alike
            return did_you_mean(likely) if likely else None
        now = [library for node in LIBRARIES[name][0] if (library := self.library_of(node)) is not None]
        return did_you_mean(now[:1] or near(name, here, 1))

    def _exists(self, name: str) -> bool:
        return name in LIBRARIES and self._letter in LIBRARIES[name][1]


_REPLACING: Final = "hi"  # the distributions in which the named libraries take the place of Nav2's own
_BESIDE: Final = "opennav_"  # packages that were beside Nav2 before they became a part of it, and still are for Humble
_SHOWN: Final = 3  # of many that are equally wrong
_REFUSED: Final = "bt_navigator refuses to configure"
