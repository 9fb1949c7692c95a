#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes what documents say of the fields of Options and Parameters, from the table in src/fields.hpp:
the lists in docs/embedding.md and the keys of strain_limiting in docs/scene.schema.json.

    docs/write_fields.py build/ci/tests/documents/describe_fields [--check]

--check writes nothing and fails where a document says otherwise.
"""
import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
LARGEST = 2**31 - 1  # of a whole number in a scene
WIDTH = 120


def plain(number):
    return int(number) if number == int(number) else number


def schema_of(field):
    bounds, kind = field["bounds"], field["type"]
    if kind == "enum":
        schema = {"enum": field["values"]}
    else:
        schema = {"type": kind}
        keys = {"least": "minimum", "above": "exclusiveMinimum", "greatest": "maximum", "below": "exclusiveMaximum"}
        schema.update({keys[key]: plain(value) for key, value in bounds.items() if key in keys})
        if kind == "integer":
            schema.setdefault("maximum", LARGEST)
    if "zero" in bounds:
        schema = {"oneOf": [{"const": 0}, schema]}
    if field["may_be_a_list"]:
        schema = {"oneOf": [schema, {"type": "array", "minItems": 1, "items": schema}]}
    return {**schema, "default": field["default"], "description": field["text"]}


def schema_line(field):
    name, schema = field["name"], schema_of(field)
    margin = " " * 8
    line = f'{margin}"{name}": {json.dumps(schema, ensure_ascii=False)}'
    if len(line) < WIDTH:
        return line
    entries = ",\n".join(f'{margin}  "{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in schema.items())
    return f'{margin}"{name}": {{\n{entries}\n{margin}}}'


def with_schema(text, fields):
    wanted = [field for field in fields["options"] + fields["parameters"] if field["in_scenes"]]
    lines = ",\n".join(schema_line(field) for field in wanted)
    pattern = re.compile(r'("strain_limiting": \{\n.*?"properties": \{\n).*?(\n      \}\n    \},)', re.DOTALL)
    changed, count = pattern.subn(lambda match: match[1] + lines + match[2], text, count=1)
    if count != 1:
        sys.exit("error: docs/scene.schema.json: no strain_limiting with properties, expected one")
    json.loads(changed)
    return changed


def legal(field):
    bounds = field["bounds"]
    if field["type"] == "enum":
        return ", ".join(f"`{value}`" for value in field["values"])
    if field["type"] == "bool":
        return "`true`, `false`"
    if field["type"] == "vector":
        return f"three numbers {field['unit']}"
    signs = {"least": "≥", "above": ">", "greatest": "≤", "below": "<"}
    limits = " and ".join(f"{signs[key]} {plain(value)}" for key, value in bounds.items() if key in signs)
    return ("0 or " if "zero" in bounds else "") + limits + (f" {field['unit']}" if field["unit"] else "")


def default(field):
    value = field["default"]
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, list):
        return ", ".join(f"{component:.6g}" for component in value)
    return f"`{value}`" if isinstance(value, str) else f"{value:.6g}"


def table(fields):
    rows = [f"| `{field['name']}` | {legal(field)} | {default(field)} | {field['text']} |" for field in fields]
    return "\n".join(["| field | legal | default | |", "|---|---|---|---|", *rows])


def with_tables(text, fields):
    for name, rows in (("Options", fields["options"] + fields["layout"]), ("Parameters", fields["parameters"])):
        begin, end = f"<!-- fields of {name}, by docs/write_fields.py -->\n", "\n<!-- end of fields -->"
        if text.count(begin) != 1:
            sys.exit(f"error: docs/embedding.md: expected one line {begin.strip()}")
        first = text.index(begin) + len(begin)
        text = text[:first] + table(rows) + text[text.index(end, first):]
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, help="describe_fields, as built")
    parser.add_argument("--check", action="store_true", help="write nothing, fail where a document says otherwise")
    arguments = parser.parse_args()
    fields = json.loads(subprocess.run([arguments.program], check=True, capture_output=True, text=True).stdout)
    old = []
    for name, change in (("embedding.md", with_tables), ("scene.schema.json", with_schema)):
        path = DOCS / name
        text = path.read_text(encoding="utf-8")
        changed = change(text, fields)
        if changed == text:
            continue
        old.append(f"docs/{name}")
        if not arguments.check:
            path.write_text(changed, encoding="utf-8")
    if arguments.check and old:
        sys.exit(f"error: {', '.join(old)}: not what src/fields.hpp says, write anew with docs/write_fields.py")


if __name__ == "__main__":
    main()
