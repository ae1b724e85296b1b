"""Export of the schema of scene files: JSON Schema, and tables of keys."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from .quantity import QUANTITIES
from .schema import Field, element_of, fields_of, is_table
from .table import LARGEST_NUMBER

DIALECT = "https://json-schema.org/draft/2020-12/schema"
_QUANTITY = r"^\s*[-+−]?(\d+\.?\d*|\.\d+)([eE][-+−]?\d+)?\s*(1\s*/|[^\s\d]).*$"
_ENDS = {
    "above": "exclusiveMinimum",
    "least": "minimum",
    "below": "exclusiveMaximum",
    "most": "maximum",
}


def table_schema(kind: Any, word: str = "", **more: Any) -> dict[str, Any]:
    """Return the JSON Schema of a table.

    Args:
        kind: Class that describes it: of keys, or of the thing itself.
        word: `type` that names the class; empty: the table has none.
        **more: JSON Schema of further keys, or of keys that differ.
    """
    known = [one for one in fields_of(kind) if one.name not in more]
    properties: dict[str, Any] = {}
    if word:
        properties["type"] = {"const": word, "description": kind.about}
    properties |= {one.name: field_schema(one) for one in known} | more
    for key, other in getattr(kind, "numbers", {}).items():
        for name, one in table_schema(other)["properties"].items():
            text = f"{one['description']}; with {key}" if key else one["description"]
            properties.setdefault(name, {**one, "description": text})
    required = [one.name for one in known if one.required]
    return object_schema(properties, required, getattr(kind, "about", ""))


def object_schema(
    properties: Mapping[str, Any], required: list[str], description: str = ""
) -> dict[str, Any]:
    """Return the JSON Schema of a table with these keys and no others."""
    found: dict[str, Any] = {"type": "object"}
    if description:
        found["description"] = description
    found |= {"properties": dict(properties), "additionalProperties": False}
    return found | ({"required": required} if required else {})


def field_schema(field: Field) -> dict[str, Any]:
    """Return the JSON Schema of one key.

    Args:
        field: From `fields_of`.
    """
    key, found = field.key, _bare_schema(field)
    goes_with = key.goes_with and f"with {key.goes_with}"
    text = "; ".join(filter(None, (key.about, key.range_words, goes_with)))
    found = {**found, "description": text}
    if isinstance(field.default, bool | int | str):
        found["default"] = field.default
    elif isinstance(field.default, float):
        number = f"{key.in_shown_unit(field.default):g} {key.unit}"
        found["default"] = number if key.kind else field.default
    if key.otherwise:
        found["x-otherwise"] = key.otherwise
    return found


def _bare_schema(field: Field) -> dict[str, Any]:
    """Return the schema of type and range of a key."""
    key, kinds = field.key, field.kinds
    if key.reader is not None:
        return dict(key.json)
    if key.of:
        return classes_schema(key.of)
    if is_table(kinds[0]):
        return table_schema(kinds[0])
    of_list = element_of(kinds[0])
    if is_table(of_list):
        return {"type": "array", "items": table_schema(of_list), "minItems": 1}
    text = {"enum": list(key.choices)} if key.choices else {"type": "string"}
    if of_list is str:
        return {"type": "array", "items": text, "uniqueItems": True}
    if of_list is float:
        return {"type": "array", "items": number_schema(key.kind)}
    ends = {_ENDS[end]: getattr(key, end) for end in _ENDS}
    ends = {name: end for name, end in ends.items() if end is not None}
    several = []
    for kind in kinds:
        if kind is str:
            several.append(text)
        elif kind is bool:
            several.append({"type": "boolean"})
        elif kind is int:
            several.append(
                {"type": "integer", "minimum": 1, "maximum": LARGEST_NUMBER, **ends}
            )
        elif element_of(kind) is float:
            several.append({"type": "array", "items": number_schema(key.kind)})
        else:
            several.append(number_schema(key.kind) | ({} if key.kind else ends))
    return several[0] if len(several) == 1 else {"anyOf": several}


def number_schema(kind: str) -> dict[str, Any]:
    """Return the JSON Schema of a quantity, or of a pure number.

    Args:
        kind: Key of `quantity.QUANTITIES`; empty for a pure number.
    """
    if not kind:
        return {"type": "number"}
    example = f"5 {QUANTITIES[kind][1]}"
    return {
        "type": "string",
        "pattern": _QUANTITY,
        "examples": [example],
        "x-kind": kind,
    }


def classes_schema(kinds: Mapping[str, type]) -> dict[str, Any]:
    """Return the JSON Schema of one of several classes: a word, or a table of numbers.

    Args:
        kinds: The classes by their words.
    """
    tables = [table_schema(kind, word) for word, kind in kinds.items()]
    bare = [w for w, one in zip(kinds, tables, strict=True) if "required" not in one]
    words = [{"enum": bare}] if bare else []
    return {"anyOf": [*words, *tables]}


def key_tables(
    schema: Mapping[str, Any], path: str = "", listed: bool = False
) -> Iterator[tuple[str, str]]:
    """Yield the key tables of a JSON Schema in Markdown, with their names.

    Args:
        schema: Schema of a table.
        path: Its dotted name; empty for a whole scene.
        listed: Whether a scene may have several such tables.
    """
    for table in schema.get("anyOf", [schema]):
        if "properties" not in table:
            continue
        rows, inner = "", []
        for name, one in table["properties"].items():
            place = f"{path}.{name}" if path else name
            part = _objects(one)
            inner += [(place, t, "items" in one) for t in part if "properties" in t]
            named = one.get("additionalProperties")
            for one_of in _objects(named) if isinstance(named, dict) else ():
                if "properties" in one_of:
                    inner.append((f"{place}.NAME", one_of, False))
            rows += _row(name, one, name in table.get("required", ()))
        if path and rows:
            about = re.sub(r"^\[+[\w.]+\]+: ", "", table.get("description", ""))
            head = "| key | holds | default | meaning |\n|---|---|---|---|\n"
            title = f"`[[{path}]]`" if listed else f"`[{path}]`"
            kind = table["properties"].get("type", {}).get("const")
            title += f", {kind}" if kind else ""
            yield path, f"### {title}\n\n{about}\n\n{head}{rows}"
        for place, part, of_list in inner:
            yield from key_tables(part, place, of_list)


def _objects(schema: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the table schemas allowed at a key."""
    if "items" in schema:
        return _objects(schema["items"])
    return list(schema.get("anyOf", [schema]))


def _row(name: str, schema: Mapping[str, Any], must: bool) -> str:
    default = schema.get("x-otherwise", schema.get("default", ""))
    default = str(default).lower() if isinstance(default, bool) else default
    shown = "required" if must else str(default)
    about = re.sub(r"^\[+[\w.]+\]+: ", "", schema.get("description", ""))
    cells = f"`{name}`", _holds(schema), shown, about
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _holds(schema: Mapping[str, Any]) -> str:
    """Describe the values allowed at a key in a few words."""
    if "$ref" in schema:
        return f"a {schema['$ref'].rpartition('/')[2]}"
    if "x-kind" in schema:
        return schema["x-kind"]
    if "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema["enum"])
    if "const" in schema:
        return f"`{schema['const']}`"
    if "items" in schema:
        return f"list: {_holds(schema['items'])}"
    if "anyOf" in schema:
        return " or ".join(dict.fromkeys(map(_holds, schema["anyOf"])))
    words = {"boolean": "true, false", "integer": "whole number", "object": "table"}
    kind = str(schema.get("type", ""))
    return words.get(kind, kind)
