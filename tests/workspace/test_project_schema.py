"""The schema of the project file: it accepts what the reader accepts, and refuses what the reader complains about."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import test_config
import test_external_requirements
import test_factory_tables
import test_project_evidence
import test_project_simulation
from hypothesis import given
from json_schema import violations

from btq_lang.commands.init import FILES
from btq_lang.workspace.config import KEYS, parse_project
from btq_lang.workspace.external_requirements import KEYS as REQUIREMENT_KEYS
from btq_lang.workspace.overrides import KEYS as OVERRIDE_KEYS
from btq_lang.workspace.project_driver import FUNCTIONS
from btq_lang.workspace.project_evidence import KEYS as EVIDENCE_KEYS
from btq_lang.workspace.project_evidence import SOURCE_KEYS
from btq_lang.workspace.project_schema import project_schema
from btq_lang.workspace.project_simulation import KEYS as SIMULATION_KEYS
from btq_lang.workspace.project_simulation import SKILL_KEYS, WORLD_KEYS

ROOT = Path(__file__).parents[2]
SCHEMA = project_schema()
toml = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")

# Draft 4, of its keywords those that the schema uses and `violations` knows.
METASCHEMA: dict[str, Any] = {
    "$ref": "#/definitions/schema",
    "definitions": {
        "schema": {
            "type": "object",
            "properties": {
                "$schema": {"const": "http://json-schema.org/draft-04/schema#"},
                "$ref": {"type": "string", "pattern": "^#/definitions/[a-z]+$"},
                "title": {"type": "string"},
                "description": {"type": "string", "minLength": 1},
                "type": {
                    "anyOf": [
                        {"$ref": "#/definitions/type"},
                        {"type": "array", "items": {"$ref": "#/definitions/type"}},
                    ]
                },
                "enum": {"type": "array", "minItems": 1},
                "pattern": {"type": "string"},
                "minLength": {"type": "integer"},
                "minItems": {"type": "integer"},
                "maxItems": {"type": "integer"},
                "minProperties": {"type": "integer"},
                "items": {"$ref": "#/definitions/schema"},
                "required": {"type": "array", "minItems": 1, "items": {"type": "string"}},
                "properties": {"$ref": "#/definitions/schemas"},
                "additionalProperties": {"anyOf": [{"type": "boolean"}, {"$ref": "#/definitions/schema"}]},
                "definitions": {"$ref": "#/definitions/schemas"},
                "allOf": {"$ref": "#/definitions/list"},
                "anyOf": {"$ref": "#/definitions/list"},
                "oneOf": {"$ref": "#/definitions/list"},
                "not": {"$ref": "#/definitions/schema"},
            },
            "additionalProperties": False,
        },
        "type": {"enum": ["array", "boolean", "integer", "null", "number", "object", "string"]},
        "schemas": {"type": "object", "additionalProperties": {"$ref": "#/definitions/schema"}},
        "list": {"type": "array", "minItems": 1, "items": {"$ref": "#/definitions/schema"}},
    },
}


INEXPRESSIBLE = re.compile(
    "unknown unit|^duplicate factory|a `p95` above|the shorter duration|above 0 s|to a year|to the next|script of"
    "|whole milliseconds"
)


def test_it_is_a_schema() -> None:
    assert list(violations(SCHEMA, METASCHEMA)) == []
    assert {*references(SCHEMA)} == {*SCHEMA["definitions"]}


def references(schema: object) -> Iterator[str]:
    for key, part in schema.items() if isinstance(schema, dict) else ():
        if key == "$ref":
            yield part.rpartition("/")[2]
        yield from references(part)
    for part in schema if isinstance(schema, list) else ():
        yield from references(part)


def test_it_has_every_key_of_the_reader_with_a_line() -> None:
    definitions = SCHEMA["definitions"]
    tables: list[tuple[dict[str, Any], Mapping[str, object]]] = [
        (SCHEMA, KEYS),
        (definitions["evidence"], EVIDENCE_KEYS),
        (definitions["signal"], SOURCE_KEYS),
        (definitions["requirements"], REQUIREMENT_KEYS),
        (definitions["overrides"]["items"], OVERRIDE_KEYS),
        (definitions["simulate"], SIMULATION_KEYS),
        (definitions["simulate"]["properties"]["driver"]["allOf"][0], FUNCTIONS),
        (definitions["simulate"]["properties"]["skills"]["allOf"][0]["additionalProperties"], SKILL_KEYS),
        (definitions["simulate"]["properties"]["world"]["allOf"][0]["additionalProperties"], WORLD_KEYS),
    ]
    for table, keys in tables:
        assert [*table["properties"]] == [*keys]
        assert all(key["description"] for key in table["properties"].values())


def test_it_accepts_the_files_of_this_repository() -> None:
    blocks = [
        block
        for page in sorted((ROOT / "docs").glob("*.md"))
        for block in re.findall(r"^```toml\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    ]
    files = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "examples").rglob("btq.toml"))]
    new = FILES["btq.toml"]
    texts = [*blocks, *files, new, re.sub(r"(?m)^# (?=\[|logs|battery|unknown)", "", new)]
    accepted = [text for text in texts if parse_project(text)[1] == ()]
    assert len(accepted) >= 5
    for text in accepted:
        assert list(violations(toml.loads(text), SCHEMA)) == [], text


def cases() -> Iterator[str]:
    """The files of the reader's own tests, right and wrong ones."""
    for module in (
        test_config,
        test_external_requirements,
        test_factory_tables,
        test_project_evidence,
        test_project_simulation,
    ):
        yield module.WHOLE
        yield from (text for text, _ in module.test_problems_and_their_places.pytestmark[0].args[1])


@pytest.mark.parametrize("text", [text for text in cases() if len(text) < 1_000])
def test_it_agrees_with_the_reader(text: str) -> None:
    problems = parse_project(text)[1]
    try:
        table = toml.loads(text)
    except ValueError:
        assert problems
        return
    messages = [problem.message for problem in problems]
    is_too_large = "= inf" in text or "0" * 400 in text  # a schema knows numbers of any size
    expressible = [each for each in messages if not INEXPRESSIBLE.search(each) and not is_too_large]
    assert bool(list(violations(table, SCHEMA))) == bool(expressible)


@given(test_config.FILES)
def test_it_agrees_with_the_reader_on_every_text(text: str) -> None:
    try:
        table = toml.loads(text)
    except ValueError:
        return
    assert bool(list(violations(table, SCHEMA))) == bool(parse_project(text)[1])
