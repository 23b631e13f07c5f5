"""The project file as a JSON schema, for editors of TOML and for the catalog of schemas at schemastore.org.

One invariant: it refuses no file that `config.parse_project` reads without a problem, and it has every key of the
tables that `config` and `project_evidence` read by.  It is written in draft 4, the only one that Taplo reads.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, TypeAlias

from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.catalog.qualities import EDITIONS
from btq_lang.catalog.versions import PRODUCTS, VERSION_3, targets
from btq_lang.diagnostics.rules import RULES
from btq_lang.workspace.config import KEYS, SEVERITIES
from btq_lang.workspace.external_requirements import DEMANDS, IMPORTED_SUFFIXES
from btq_lang.workspace.external_requirements import KEYS as REQUIREMENT_KEYS
from btq_lang.workspace.factories import KEYS as FACTORY_KEYS
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.overrides import KEYS as OVERRIDE_KEYS
from btq_lang.workspace.project_driver import FUNCTIONS
from btq_lang.workspace.project_evidence import KEYS as EVIDENCE_KEYS
from btq_lang.workspace.project_evidence import NUMBERS, OF_A_FILE, OF_A_TOPIC, SOURCE_KEYS, TEXTS
from btq_lang.workspace.project_simulation import KEYS as SIMULATION_KEYS
from btq_lang.workspace.project_simulation import OF_ACTIONS, OF_CONDITIONS, SKILL_KEYS, WORLD_KEYS

Json: TypeAlias = "dict[str, Any]"


_NUMBER: Final = r"[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?"
_KINDS: Final = {"action": OF_ACTIONS, "condition": OF_CONDITIONS}


def _ending(suffixes: tuple[str, ...]) -> str:
    """A pattern of the names that end in one of some suffixes."""
    return rf"\.({'|'.join(suffix.removeprefix('.') for suffix in suffixes)})$"


def project_schema() -> Json:
    """The schema of btq.toml."""
    return {
        "$schema": "http://json-schema.org/draft-04/schema#",
        "title": "btq.toml",
        "description": "What holds for all missions of a project of btq",
        **_table({key: {"description": doc, "allOf": [_form(form)]} for key, (_, _, form, doc) in KEYS.items()}),
        "definitions": {
            "engine": {"enum": [VERSION_3, *targets(), *PRODUCTS]},
            "engines": {"anyOf": [_form("engine"), _list(_form("engine"), minItems=1)]},
            "edition": {"enum": [*EDITIONS]},
            "strings": _list({"type": "string"}),
            "nodes": _list({"anyOf": [{"enum": [*PACKAGED]}, {"type": "string", "pattern": _ending(CPP_SUFFIXES)}]}),
            "rule": {"enum": [*RULES]},
            "rules": _list(_form("rule")),
            "severity": {"enum": [*SEVERITIES]},
            "severities": _table(
                {name: {"description": rule.summary, "allOf": [_form("severity")]} for name, rule in RULES.items()}
            ),
            "overrides": _list({**_override(), "required": ["include"]}),
            "text": {"type": "string", "minLength": 1},
            "number": {"type": "number"},
            "evidence": _evidence(),
            "signal": _signal(),
            "duration": _pattern(rf"^\s*\+?{_NUMBER}[ \t]*[A-Za-z]+\s*$"),
            "quantity": {"anyOf": [_form("number"), _pattern(rf"^\s*(\+|-)?{_NUMBER}([ \t]*[^ \t]+)?\s*$")]},
            "simulate": _simulation(),
            "requirements": _requirements(),
            "factories": _list(_factory()),
        },
    }


def _override() -> Json:
    forms = {"include": _list(_form("text"), minItems=1), "ignore": _form("rules"), "rules": _form("severities")}
    return _described(OVERRIDE_KEYS, forms)


def _evidence() -> Json:
    forms = {
        "logs": _list(_form("text")),
        "store": _form("text"),
        "signals": {"type": "object", "additionalProperties": _form("signal")},
    }
    return _described(EVIDENCE_KEYS, forms)


def _requirements() -> Json:
    imports = _list({"type": "string", "pattern": _ending(IMPORTED_SUFFIXES)})
    forms = {"import": imports, **{key: {"enum": [*DEMANDS]} for key in ("approval", "source")}}
    return _described(REQUIREMENT_KEYS, forms)


def _signal() -> Json:
    """The source of a signal: a field of a topic, or a column of a file."""
    forms = {**dict.fromkeys((*TEXTS, "unit"), _form("text")), **dict.fromkeys(NUMBERS, _form("number"))}
    keys = {key: {"description": doc, "allOf": [forms[key]]} for key, doc in SOURCE_KEYS.items()}
    kinds = [
        {"required": [kind, wanted], "not": {"anyOf": [{"required": [each]} for each in others]}}
        for kind, wanted, others in (OF_A_TOPIC, OF_A_FILE)
    ]
    return {**_table(keys), "oneOf": kinds}


def _simulation() -> Json:
    quantities = {"type": "object", "additionalProperties": _form("quantity")}
    world = {
        "start": {"anyOf": [_form("quantity"), {"type": "boolean"}, _pattern(r"\S")]},
        "rate": _form("quantity"),
        "while": quantities,
        "between": {"anyOf": [_list(_form("quantity"), minItems=2, maxItems=2), {"enum": [[]]}]},
    }
    signal = {**_described(WORLD_KEYS, world), "required": ["start"]}
    driver = {
        **_described(FUNCTIONS, dict.fromkeys(FUNCTIONS, _form("duration"))),
        "oneOf": [{"required": [function]} for function in FUNCTIONS],
    }
    tables = {"skills": _skill(), "world": signal}
    forms = {key: {"type": "object", "additionalProperties": table} for key, table in tables.items()}
    return _described(SIMULATION_KEYS, {**forms, "driver": driver})


def _skill() -> Json:
    """What a skill does: either an action or a condition."""
    duration = _form("duration")
    pairs = [("from", "to"), ("median", "p95")]
    spreads = [{**_table(dict.fromkeys(pair, duration)), "required": [*pair]} for pair in pairs]
    written = {"anyOf": [{"type": ["number", "boolean"]}, _pattern(r"\S")]}
    forms = {
        "takes": {"anyOf": [duration, _list(duration, minItems=2, maxItems=2), *spreads]},
        "succeeds": _pattern(r"^\s*(100(\.0+)?|[0-9]{1,2}(\.[0-9]+)?)[ \t]*%\s*$"),
        "writes": {"type": "object", "additionalProperties": written, "minProperties": 1},
        "is": _pattern(r"\S"),
        "fails": _pattern(rf"^\s*{_NUMBER} per ({_NUMBER} ?)?[A-Za-z]+\s*$"),
        "for": duration,
    }
    has_any = {name: {"anyOf": [{"required": [key]} for key in keys]} for name, keys in _KINDS.items()}
    is_both = {"allOf": [*has_any.values()]}
    is_alone = [
        {"required": [key], "not": {"required": [other]}} for key, other in (("fails", "for"), ("for", "fails"))
    ]
    return {**_described(SKILL_KEYS, forms), "minProperties": 1, "not": {"anyOf": [is_both, *is_alone]}}


def _described(keys: Mapping[str, str], forms: Json) -> Json:
    """A table with the line of each key and the form of its values."""
    return _table({key: {"description": doc, "allOf": [forms[key]]} for key, doc in keys.items()})


def _pattern(pattern: str) -> Json:
    return {"type": "string", "pattern": pattern}


def _factory() -> Json:
    texts = _list(_form("text"))
    forms = {"name": _form("text"), "nav2": _form("text"), "main": {"anyOf": [_form("text"), texts]}}
    keys = {key: {"description": doc, "allOf": [forms.get(key, texts)]} for key, doc in FACTORY_KEYS.items()}
    return {**_table(keys), "required": ["name"]}


def _table(keys: Json) -> Json:
    return {"type": "object", "properties": keys, "additionalProperties": False}


def _list(items: Json, **more: int) -> Json:
    return {"type": "array", "items": items, **more}


def _form(name: str) -> Json:
    return {"$ref": f"#/definitions/{name}"}
