#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""exported_symbols.py LIBRARY: lists what a shared library exports; exit 1 unless that is what the public headers mark
APSL_API, all of it and nothing else."""
import re
import subprocess
import sys
from pathlib import Path

HEADERS = Path(__file__).resolve().parents[2] / "include" / "apsl"


def marked():
    """Functions and classes marked APSL_API, with the namespace of the C++ ones."""
    functions, classes = set(), set()
    for header in sorted(HEADERS.iterdir()):
        text = header.read_text()
        namespace = "" if header.suffix == ".h" else "apsl::"
        classes |= {namespace + name for name in re.findall(r"^class APSL_API (\w+)", text, re.M)}
        functions |= {namespace + name for name in re.findall(r"^APSL_API\s[^(]*?\b(\w+)\(", text, re.M)}
    return functions, classes


def exported(library):
    """Demangled, one name for every symbol version and kind of constructor."""
    lines = subprocess.run(["nm", "--dynamic", "--defined-only", "--demangle", library], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    return sorted({line.split(" ", 2)[2] for line in lines})


def owner(symbol, classes):
    """The class a symbol belongs to, "" where it is none of the marked ones."""
    name = re.sub(r"^(vtable|typeinfo name|typeinfo) for ", "", symbol)
    for one in classes:
        if name == one or re.match(rf"{one}::[\w~=]+( |\(|$|=)", name) or name.startswith(f"{one}::operator"):
            return one
    return ""


def main():
    functions, classes = marked()
    symbols = exported(sys.argv[1])
    print("\n".join(symbols))
    mistakes = []
    for symbol in symbols:
        if symbol.split("(")[0] not in functions and not owner(symbol, classes):
            mistakes.append(f"exported, but not marked APSL_API: {symbol}")
    names = {symbol.split("(")[0] for symbol in symbols}
    mistakes += [f"marked APSL_API, but not exported: {name}" for name in sorted(functions - names)]
    mistakes += [f"marked APSL_API, but nothing of it exported: {name}" for name in sorted(classes)
                 if name not in {owner(symbol, classes) for symbol in symbols}]
    for mistake in mistakes:
        print(f"{sys.argv[1]}: {mistake}", file=sys.stderr)
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
