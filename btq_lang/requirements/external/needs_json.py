"""The needs.json that sphinx-needs writes: the needs of its current version."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any, Final

from btq_lang.requirements.external.fields import ImportProblem, requirement
from btq_lang.util.text import LineIndex
from btq_lang.workspace.external_requirements import ExternalRequirement


def read_requirements(path: str, text: str) -> list[ExternalRequirement]:
    """The needs, in the order of the file.

    Raises:
        ImportProblem: the text is not a needs.json.
    """
    top = _values(text)
    versions = top.get("versions") if isinstance(top, dict) else None
    if not isinstance(versions, dict):
        raise ImportProblem("not a needs.json: expected an object with `versions`", 1)
    current = top.get("current_version")
    if current not in versions and len(versions) == 1:
        [current] = versions
    if not isinstance(current, str) or current not in versions:
        raise ImportProblem("`current_version` must name one of the `versions`", 1)
    version = versions[current]
    if not isinstance(version, dict) or not isinstance(needs := version.get("needs"), dict):
        raise ImportProblem(f"the version `{current}` has no object `needs`", 1)
    lines = LineIndex(text)
    places = {key: lines.position(start).line + 1 for key, start in _keys_below(text, ("versions", current, "needs"))}
    return [_need(key, need, path, places[key]) for key, need in needs.items()]


def _need(key: str, need: object, path: str, line: int) -> ExternalRequirement:
    if not isinstance(need, dict):
        raise ImportProblem(f"the need `{key}` must be an object", line)
    return requirement(key, {name: value for name, value in need.items() if isinstance(value, str)}, path, line)


def _values(text: str) -> Any:
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise ImportProblem(f"not JSON: {error.msg[:1].lower()}{error.msg[1:]}", error.lineno, error.colno) from error
    except ValueError as error:  # a number with more digits than Python reads
        raise ImportProblem("a number has too many digits", 1) from error
    except RecursionError as error:
        raise ImportProblem("nested too deeply", 1) from error


def _keys_below(text: str, names: tuple[str, ...]) -> Iterator[tuple[str, int]]:
    """The keys of the object that is below some names in valid JSON, each with its offset: the reader of the standard
    library gives values only."""
    start = _after_blanks(text, 0)
    for name in names:
        start = [value for key, _, value in _members(text, start) if key == name][-1]  # the one that `json` keeps
    return ((key, place) for key, place, _ in _members(text, start))


def _members(text: str, start: int) -> Iterator[tuple[str, int, int]]:
    """The keys of the object at an offset, each with its offset and that of its value."""
    at = _after_blanks(text, start + 1)
    while text[at] == '"':
        key, end = _DECODER.raw_decode(text, at)
        value = _after_blanks(text, _after_blanks(text, end) + 1)
        yield key, at, value
        at = _after_blanks(text, _DECODER.raw_decode(text, value)[1])
        at = _after_blanks(text, at + 1) if text[at] == "," else at


def _after_blanks(text: str, start: int) -> int:
    blanks = _BLANKS.match(text, start)
    return blanks.end() if blanks else start


_BLANKS: Final = re.compile(r"[ \t\r\n]*")
_DECODER: Final = json.JSONDecoder()
