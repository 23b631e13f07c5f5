"""Libraries of nodes that bt_navigator loads: which, and what is wrong with those that parameters name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.nav2.libraries import LIBRARIES
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.nav2.own_libraries import OwnLibraries
from btq_lang.nav2.parameters import Parameters, ParameterText
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span

NAMES: Final = "plugin_lib_names"


class Libraries:
    """The libraries that bt_navigator loads in a distribution.

    Args:
        own: those that the team builds.

    Attributes:
        nodes: that the libraries among them register of which that is known.
        are_of_nav2: whether all are Nav2's.
        are_all_known: whether it is known of all.
    """

    def __init__(self, parameters: Parameters, distribution: str, own: OwnLibraries) -> None:
        self._letter = distribution[0]
        self._shown = distribution.capitalize()
        self._named = parameters.texts(NAMES)
        usual = {name for name, (_, _, loaded) in LIBRARIES.items() if self._letter in loaded}
        self._built_in = usual if self._named is None or self._letter not in _REPLACING else set()
        loaded = self._built_in | {library.text for library in self._named or ()}
        of_nav2 = {node for name in loaded if self._exists(name) for node in LIBRARIES[name][0]}
        self._own = own.of_node
        self.nodes = of_nav2 | {node for node, libraries in own.of_node.items() if libraries & loaded}
        others = [library.text for library in self._named or () if not self._exists(library.text)]
        self.are_of_nav2 = not others
        self.are_all_known = own.whole.issuperset(others)

    def library_of(self, node: str) -> str | None:
        """The library that registers a node: one of Nav2 in this distribution, or one of the team."""
        of_nav2 = (name for name, (nodes, _, _) in LIBRARIES.items() if node in nodes and self._exists(name))
        return next(iter((*sorted(self._own.get(node, ())), *of_nav2)), None)

    def findings(self) -> Iterator[Diagnostic]:
        """What is wrong with the libraries that the parameters name."""
        named = self._named or ()
        yield from self._loaded_by_nav2([library for library in named if library.text in self._built_in])
        first: dict[str, Span] = {}
        for library in named:
            if library.text in first and library.text not in self._built_in:
                related = (Related(Place(first[library.text]), "first one"),)
                message = f"`{library.text}` is named twice, so its nodes are registered twice"
                yield Diagnostic("library-loaded-twice", library.span, message, related, (_REFUSED,))
            elif not self._exists(library.text) and (meant := self._suggestion(library.text)) is not None:
                message = f"Nav2 has no library `{library.text}` in {self._shown}{meant}"
                yield Diagnostic("unknown-library", library.span, message, notes=(_REFUSED,))
            first.setdefault(library.text, library.span)

    def _loaded_by_nav2(self, named: list[ParameterText]) -> Iterator[Diagnostic]:
        """The libraries that Nav2 loads without a name: one finding, as a file of another distribution names all."""
        if not named:
            return
        first, *others = named
        more = f" and {len(others)} more of the named libraries" if others else ""
        message = f"Nav2 loads `{first.text}`{more} by itself in {self._shown}, so nodes are registered twice"
        related = tuple(Related(Place(library.span), "this one too") for library in others[:_SHOWN])
        yield Diagnostic("library-loaded-twice", first.span, message, related, (_REFUSED,))

    def _suggestion(self, name: str) -> str | None:
        """What a library that is not Nav2's in this distribution may mean, for a message; None: it is a team's own."""
        existing = [library for library in LIBRARIES if self._exists(library)]
        if name in LIBRARIES and name.startswith(_BESIDE):
            return None
        if name not in LIBRARIES:
            likely = [
                library for library in existing if distance(name, library, 1) <= 1
            ]  # own ones are often named alike
            return did_you_mean(likely) if likely else None
        successors = [library for node in LIBRARIES[name][0] if (library := self.library_of(node)) is not None]
        return did_you_mean(successors[:1] or near(name, existing, 1))

    def _exists(self, name: str) -> bool:
        return name in LIBRARIES and self._letter in LIBRARIES[name][1]


_REPLACING: Final = "hi"  # the distributions in which the named libraries take the place of Nav2's own
_BESIDE: Final = "opennav_"  # packages that were beside Nav2 before they became a part of it, and still are for Humble
_SHOWN: Final = 3  # of many that are equally wrong
_REFUSED: Final = "bt_navigator refuses to configure"
