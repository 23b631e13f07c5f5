"""Parameters of bt_navigator that no code of Nav2 reads in a distribution, in any place.

One invariant: a library, a navigator or C++ of a team's own may read any parameter of bt_navigator: with one, a name
that is near none of Nav2 gets a hint, and none if the C++ is at hand and has the name.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.catalog.nav2.navigator import NAVIGATORS, OTHER_PARAMETERS, OWN_PACKAGE, PARAMETERS
from btq_lang.catalog.nav2.servers import SERVERS
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.nav2.parameters import Parameters
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, distance, near


class OwnCode(Record):
    """What a team adds to bt_navigator.

    Attributes:
        texts: of the C++ that the project names.
        is_loaded: whether bt_navigator loads a library or a navigator that is not Nav2's.
    """

    texts: tuple[str, ...]
    is_loaded: bool

    def has(self, name: str) -> bool:
        """Whether the C++ has a string with a name."""
        return any(f'"{name}"' in text or f'.{name}"' in text for text in self.texts)


def unknown_parameters(parameters: Parameters, distribution: str, own: OwnCode) -> Iterator[Diagnostic]:
    """The parameters that nothing reads, each with what may be meant; of a section that is unknown, only its name."""
    names = {name.removeprefix("*") for name, row in PARAMETERS.items() if distribution[0] in row.of}
    names |= {name for name, letters in OTHER_PARAMETERS.items() if distribution[0] in letters}
    navigators = {*NAVIGATORS, *parameters.navigators}
    others = {name for name, plugin in parameters.plugins if not plugin.text.startswith(OWN_PACKAGE)}
    for name, (key, _) in parameters.values.items():
        section, point, rest = name.partition(".")
        is_below = section in navigators
        if parameters.row(name) is not None or section in names or (is_below and not point):
            continue
        if point and not is_below and section in parameters.values:
            continue  # which is what is unknown
        wrong, candidates = (f".{rest}", names) if is_below else (section, names | navigators)
        likely = [
            candidate
            for candidate in near(wrong, candidates, 1)
            if distance(wrong, candidate) * _LETTERS_AN_EDIT <= len(wrong)
        ]
        severity: Severity | None = None
        notes: tuple[str, ...] = ()
        readers = _readers(section, distribution) if not is_below else []
        if rest in names:
            message = f"Nav2 does not read `{rest}` below `{section}`: write it one level up"
        elif likely and not readers:
            message = f"Nav2 has no parameter `{name}`{did_you_mean([name.replace(wrong, likely[0])])}"
        elif name in parameters.shared or section in others or "$(" in name or own.has(rest or name):
            continue
        else:
            message = f"Nav2 has no parameter `{name}` in {distribution.capitalize()}"
            message += did_you_mean(sorted(_with_words_of(name, names, navigators)))
            if readers:
                message = f"bt_navigator does not read `{name}`: {_listed(readers)}"
            severity, notes = (Severity.HINT, (_OWN,)) if own.is_loaded else (None, (_SILENT,))
        yield Diagnostic("nav2-parameter", key.span, message, notes=notes, severity=severity)


def _readers(name: str, distribution: str) -> list[str]:
    """The other nodes of Nav2 that read a parameter of this name."""
    return [
        node
        for node, rows in SERVERS.items()
        if any(distribution[0] in letters and name in text.split() for letters, text in rows.items())
    ]


def _listed(nodes: list[str]) -> str:
    """What reads a parameter, as a clause."""
    *others, last = nodes
    return f"{', '.join(others)} and {last} read it" if others else f"{last} reads it"


def _with_words_of(name: str, names: Iterable[str], navigators: Iterable[str]) -> Iterator[str]:
    """The parameters that have all the words of a name: `default_bt_xml` lacks some of theirs."""
    words = name.split("_")
    for parameter in names if len(words) > 1 else ():
        if {*words} <= {*parameter.removeprefix(".").split("_")}:
            yield from (f"{navigator}{parameter}" for navigator in navigators) if parameter[0] == "." else (parameter,)


_LETTERS_AN_EDIT: Final = 6  # fewer would take the names of a team's own parameters for misspelt ones
_SILENT: Final = "ROS 2 sets it without a word, and the default counts"
_OWN: Final = "a node of your own may read it"
