"""What of a value does not fit its JSON schema."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any


def violations(
    value: Any, schema: dict[str, Any], at: str = "$", definitions: dict[str, Any] | None = None
) -> Iterator[str]:
    """Where a value does not keep a schema: as much of JSON Schema as the schemas of btq use."""
    definitions = (schema.get("$defs") or schema.get("definitions", {})) if definitions is None else definitions
    if "$ref" in schema:
        yield from violations(value, definitions[schema["$ref"].rpartition("/")[2]], at, definitions)
    if "const" in schema and value != schema["const"]:
        yield f"{at}: {value!r}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{at}: {value!r}"
    types = schema.get("type", [])
    if types and not any(is_of(value, each) for each in ([types] if isinstance(types, str) else types)):
        yield f"{at}: {value!r} is no {types}"
    if "pattern" in schema and isinstance(value, str) and not re.search(schema["pattern"], value):
        yield f"{at}: {value!r}"
    if isinstance(value, dict):
        yield from (f"{at}: no {key}" for key in schema.get("required", ()) if key not in value)
        for key, part in value.items():
            if key in schema.get("properties", {}):
                yield from violations(part, schema["properties"][key], f"{at}.{key}", definitions)
            elif schema.get("additionalProperties") is False:
                yield f"{at}: unknown {key}"
            elif isinstance(schema.get("additionalProperties"), dict):
                yield from violations(part, schema["additionalProperties"], f"{at}.{key}", definitions)
    for index, item in enumerate(value if isinstance(value, list) else ()):
        yield from violations(item, schema.get("items", {}), f"{at}[{index}]", definitions)
    if isinstance(value, list) and len(value) < schema.get("minItems", 0):
        yield f"{at}: fewer than {schema['minItems']}"
    if isinstance(value, list) and len(value) > schema.get("maxItems", len(value)):
        yield f"{at}: more than {schema['maxItems']}"
    if isinstance(value, dict) and len(value) < schema.get("minProperties", 0):
        yield f"{at}: fewer than {schema['minProperties']}"
    if isinstance(value, str) and len(value) < schema.get("minLength", 0):
        yield f"{at}: shorter than {schema['minLength']}"
    for part in schema.get("allOf", ()):
        yield from violations(value, part, at, definitions)
    if "anyOf" in schema and all(any(violations(value, part, at, definitions)) for part in schema["anyOf"]):
        yield f"{at}: {value!r} fits none"
    if "oneOf" in schema:
        fitting = sum(not any(violations(value, part, at, definitions)) for part in schema["oneOf"])
        if fitting != 1:
            yield f"{at}: {value!r} fits {fitting}"
    if "not" in schema and not any(violations(value, schema["not"], at, definitions)):
        yield f"{at}: {value!r} is excluded"


def is_of(value: object, type_: str) -> bool:
    if type_ == "null":
        return value is None
    if type_ in ("integer", "number"):
        return isinstance(value, int | float if type_ == "number" else int) and not isinstance(value, bool)
    classes = {"object": dict, "array": list, "string": str, "boolean": bool}
    return isinstance(value, classes[type_])
