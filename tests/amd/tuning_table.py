# SPDX-License-Identifier: MIT
"""The table of docs/amd_registers.md: what each kernel uses on each GPU."""
import re

BEGIN = "<!-- begin: tests/amd/check_kernels.py --write-table -->"
END = "<!-- end -->"
WORK_GROUP_SIZE = "APSLK_WORK_GROUP_SIZE=256"


def _label(key, names):
    """`cg_update.cl:cg_update APSLK_WORK_GROUP_SIZE=256` to `cg_update`, with the defines that make the variant and,
    where several of `names` (source:kernel) end alike, the file."""
    name, *defines = key.split(" ")
    source, kernel = name.split(":")
    others = [d.removeprefix("APSLK_").lower() for d in defines if d != WORK_GROUP_SIZE]
    if sum(other.endswith(f":{kernel}") for other in names) > 1:
        others.insert(0, source)
    return kernel + (", " + ", ".join(others) if others else "")


def table(compiler, results, targets):
    """Markdown between the two marks. `results` is {kernel variant: {target: Usage}}."""
    lines = [BEGIN, f"{compiler}; groups of 256; vector registers / scalar registers / waves per SIMD.", "",
             "| Kernel | LDS, bytes | " + " | ".join(str(t) for t in targets) + " |",
             "|---|---" + "|---" * len(targets) + "|"]
    names = {key.split(" ")[0] for key in results}
    for key in sorted(results):
        if "APSLK_WORK_GROUP_SIZE=" in key and WORK_GROUP_SIZE not in key.split(" "):
            continue
        usages = [results[key][str(t)] for t in targets]
        cells = [f"{u.vgprs} / {u.sgprs} / {u.waves_per_simd}" for u in usages]
        lines.append(f"| {_label(key, names)} | {max(u.local_bytes for u in usages)} | " + " | ".join(cells) + " |")
    return "\n".join(lines + [END])


def _split(document):
    match = re.fullmatch(f"(.*){re.escape(BEGIN)}.*{re.escape(END)}(.*)", document, re.DOTALL)
    if not match:
        raise ValueError(f"no lines '{BEGIN}' and '{END}', expected the table between them")
    return match.groups()


def write(path, new_table):
    before, after = _split(path.read_text(encoding="utf-8"))
    path.write_text(before + new_table + after, encoding="utf-8")


def _cells(lines):
    """{(row, column): cell} of a table."""
    rows = [[cell.strip() for cell in line.strip("| \n").split("|")] for line in lines if line.startswith("| ")]
    return {(row[0], column): cell for row in rows[1:] for column, cell in zip(rows[0][1:], row[1:])}


def is_current(path, new_table):
    """Whether the document's table has the same kernels, and in each column of this one the same figures; another
    version of the compiler has nothing to say about it."""
    before, after = _split(document := path.read_text(encoding="utf-8"))
    lines = document[len(before):len(document) - len(after)].splitlines()
    if new_table.splitlines()[1].split(";")[0] not in document:
        return True
    wanted, stored = _cells(new_table.splitlines()), _cells(lines)
    return ({row for row, _ in wanted} == {row for row, _ in stored}
            and all(stored.get(place) == cell for place, cell in wanted.items()))
