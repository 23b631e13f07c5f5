"""Parameters of bt_navigator that a distribution does not read, refuses, or reads as another type; keys around them.

One invariant: a library, a navigator or C++ of a team's own may read any parameter of bt_navigator: with one, a name
that is near none of Nav2 gets a hint, and none if the C++ is at hand and has the name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.navigator import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    NAVIGATORS,
    OTHER_PARAMETERS,
    OWN_PACKAGE,
    PARAMETERS,
    STRINGS,
)
from btq_lang.catalog.nav2.servers import SERVERS
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.nav2.parameters import NODE, Parameters
from btq_lang.nav2.yaml_reader import YamlValue
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span


def file_findings(parameters: Parameters) -> Iterator[Diagnostic]:
    """Keys with which bt_navigator does not find its parameters, in any distribution."""
    for wrong, right in parameters.misspelt:
        message = f"unknown key `{wrong.text}`{did_you_mean((right,))}"
        notes = ("no node that is given this file starts",) if right != NODE else ()
        severity = Severity.ERROR if right != NODE else None
        yield Diagnostic("nav2-parameter", wrong.span, message, notes=notes, severity=severity)
    if parameters.place is None and not parameters.misspelt:
        yield Diagnostic("nav2-parameter", Span(0, 0), "this file has no parameters of bt_navigator")


def distribution_unknown(parameters: Parameters) -> Diagnostic:
    """The diagnostic for a file whose distribution is unknown."""
    choices = ", ".join(f'"nav2-{distribution}"' for distribution in DISTRIBUTIONS)
    message = "the parameters of bt_navigator do not tell for which distribution of ROS 2 they are"
    notes = (f"write `nodes = [...]` with one of {choices} into btq.toml",)
    return Diagnostic("nav2-distribution", parameters.place or Span(0, 0), message, notes=notes)


def parameter_findings(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    """What is wrong with names and types of parameters in a distribution."""
    yield from file_findings(parameters)
    yield from _unread(parameters, distribution)
    yield from _mistyped(parameters, distribution)
    yield from _classes(parameters, distribution) if distribution[0] != "h" else ()


def _unread(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    shown = distribution.capitalize()
    for name, row in parameters.unread(distribution):
        parameter = PARAMETERS[row]
        notes = (parameter.instead,) if parameter.instead else ()
        key = parameters.key(name) or Span(0, 0)
        if distribution[0] in parameter.refused_in:
            message = f"bt_navigator refuses to start with `{name}` in {shown}"
            yield Diagnostic("nav2-parameter", key, message, notes=notes, severity=Severity.ERROR)
        else:
            yield Diagnostic("nav2-parameter", key, f"Nav2 does not read `{name}` in {shown}", notes=notes)


def _mistyped(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    for name, (_, value) in parameters.values.items():
        row = parameters.row(name)
        expected = PARAMETERS[row].type if row is not None and distribution[0] in PARAMETERS[row].of else ""
        if expected and not _may_be(expected, value):
            message = f"`{name}` must be a{'n' * (expected == INTEGER)} {expected}"
            notes = ("bt_navigator refuses to configure",)
            yield Diagnostic("nav2-parameter", value.span, message, notes=notes, severity=Severity.ERROR)


def _may_be(expected: str, value: YamlValue) -> bool:
    """Whether ROS 2 reads a value as a type; an empty value, or one that a launch file replaces, may be of any."""
    if value.text is None:
        return expected == STRINGS
    if "$(" in value.text or (value.is_plain and value.text in ("", "~", "null")):
        return True
    return expected != STRINGS and value.is_plain and _FORMS[expected].fullmatch(value.text) is not None


def _classes(parameters: Parameters, distribution: str) -> Iterator[Diagnostic]:
    """Navigators whose class the distribution does not have."""
    shown = distribution.capitalize()
    for navigator, plugin in parameters.plugins:
        class_ = NAVIGATORS[navigator][2] if navigator in NAVIGATORS else ""
        right, wrong = (
            f"{OWN_PACKAGE}{sign}{class_}" for sign in (("/", "::") if distribution[0] == "i" else ("::", "/"))
        )
        prefix = right.removesuffix(class_)
        classes = [f"{prefix}{name}" for _, _, name in NAVIGATORS.values()]
        message = ""
        if plugin.text == wrong:
            message = f"the class of this navigator is called `{right}` in {shown}"
        elif class_ and plugin.text.startswith(prefix) and plugin.text not in classes:
            message = f"Nav2 has no navigator `{plugin.text}`{did_you_mean(near(plugin.text, classes, 1))}"
        if message:
            yield Diagnostic("nav2-parameter", plugin.span, message, severity=Severity.ERROR)


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
    """The parameters that nothing reads, each with suggestions; of an unknown section only its name is reported."""
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
            continue  # the section itself is reported
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


_FORMS: Final = {
    INTEGER: re.compile(r"[-+]?(0[xX][0-9a-fA-F]+|\d+)"),
    DOUBLE: re.compile(r"[-+]?(\d+\.\d*|\.\d+)([eE][-+]?\d+)?|[-+]?\d+[eE][-+]?\d+|[-+]?\.(inf|Inf|INF|nan|NaN|NAN)"),
    BOOLEAN: re.compile(r"[yYnN]|yes|Yes|YES|no|No|NO|true|True|TRUE|false|False|FALSE|on|On|ON|off|Off|OFF"),
}
_LETTERS_AN_EDIT: Final = 6  # fewer would take the names of a team's own parameters for misspelt ones
_SILENT: Final = "ROS 2 sets it without a word, and the default counts"
_OWN: Final = "a node of your own may read it"
