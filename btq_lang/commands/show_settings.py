"""`btq check --show-settings`: the settings that hold for files, and where each comes from."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from btq_lang.catalog.versions import VERSIONS
from btq_lang.projects.messages import CommandOutput
from btq_lang.util.toml_places import find_key
from btq_lang.workspace.config import KEYS, Project, keys_above, table_of
from btq_lang.workspace.loader import FoundProject, absolute, find_project, read, shown
from btq_lang.workspace.overrides import overrides_at


def show_settings(paths: Iterable[str], options: Mapping[str, object], messages: CommandOutput) -> int:
    """Print the settings of each path; returns the exit code.

    Args:
        options: those of the command line, by the keys of a project file.
    """
    homes = [(path, find_project(path)) for path in paths]
    problems = tuple(dict.fromkeys(problem for _, home in homes for problem in home.problems))
    messages.problems(problems)
    for number, (path, home) in enumerate(homes if not problems else ()):
        messages.result("\n" * (number > 0) + f"# {path}")
        for setting, source in _settings(home, absolute(path), options):
            messages.result(f"{setting:<40} # {source}")
    return 2 if problems else 0


def _settings(home: FoundProject, path: str, options: Mapping[str, object]) -> Iterator[tuple[str, str]]:
    """Settings as lines of TOML, and where each comes from."""
    file = shown(home.path) if home.path is not None else ""
    above = keys_above(file)
    text = (read(home.path)[0] or "") if home.path is not None else ""
    table = table_of(text, above)

    def place(*keys: str) -> str:
        position = find_key(text, (*above, *keys))
        return file if position is None else f"{file}:{position.line + 1}"

    for key in (key for key in KEYS if key not in _OF_RULES):
        values = [(table[key], place(key))] if key in table else []
        if options.get(key):
            values = [*(values if key == "ignore" else ()), (options[key], f"--{key}")]
        for value, source in values or [(_DEFAULTS.get(key, []), "default")]:
            yield f"{key} = {_value(value)}", source
    rules = {rule: (severity, place("rules", rule)) for rule, severity in table.get("rules", {}).items()}
    for number in overrides_at(home.project.root, home.project.overrides, path):
        override, source_at = table["overrides"][number], place("overrides", f"[{number}]")
        rules.update((rule, ("off", source_at)) for rule in override.get("ignore", ()))
        rules.update((rule, (severity, source_at)) for rule, severity in override.get("rules", {}).items())
    for rule, (severity, source) in sorted(rules.items()):
        yield f"rules.{rule} = {_value(severity)}", source


def _value(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, default=str)  # a date


_OF_RULES: Final = ("rules", "overrides")
_DEFAULTS: Final = {
    "engine": VERSIONS,
    "qualities": Project().qualities,
    "baseline": "",
    "evidence": {},
    "simulate": {},
    "requirements": {},
}
