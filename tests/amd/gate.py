# SPDX-License-Identifier: MIT
"""What a compiled kernel may not do, and the budget it must keep to."""
import json

LOCAL_MEMORY_LIMIT = 65536  # bytes a work-group on every target

# A budget is rounded up to the blocks in which registers are handed out on most targets: a change inside a block costs
# nothing, and a change that costs a wave per SIMD shows there.
VGPR_BLOCK = 8
SGPR_BLOCK = 16

# Scalar registers that do not fit go to lanes of a vector register: a move each, no memory. A few are let pass.
SCALAR_SPILL_LIMIT = 8


def compile_finding(message):
    """A refusal of the compiler as one line."""
    lines = [line for line in message.splitlines() if "error:" in line] or message.splitlines() or ["no message"]
    kind = "local memory" if "local memory (" in lines[0] and "exceeds limit" in lines[0] else "compile"
    return f"{kind}: {lines[0]}"


def findings(usage, wave_size):
    """Why a kernel is refused, budget aside: lines of the form `reason: detail`."""
    found = []

    def refuse(reason, detail):
        found.append(f"{reason}: {detail}")

    if usage.wave_size != wave_size:
        refuse("wave size", f"{usage.wave_size} lanes, asked for {wave_size}")
    if usage.scratch_bytes > 0:
        refuse("scratch", f"{usage.scratch_bytes} bytes a lane, expected none")
    if usage.vgpr_spills > 0 or usage.sgpr_spills > SCALAR_SPILL_LIMIT:
        refuse("spill", f"{usage.vgpr_spills} vector and {usage.sgpr_spills} scalar registers, expected none and at most "
                        f"{SCALAR_SPILL_LIMIT}")
    if usage.local_bytes > LOCAL_MEMORY_LIMIT:
        refuse("local memory", f"{usage.local_bytes} bytes a work-group, at most {LOCAL_MEMORY_LIMIT} allowed")
    # A call makes every other figure a guess.
    for reason, unwanted in (("call", lambda m: m.startswith(("s_swappc", "s_call"))),
                             ("flat access", lambda m: m.startswith("flat_")),
                             ("double", lambda m: "f64" in m)):
        mnemonics = sorted(m for m in usage.instructions if unwanted(m))
        if mnemonics:
            refuse(reason, f"{', '.join(mnemonics)}, expected none")
    return found


def round_up(value, block):
    return (value + block - 1) // block * block


def budget_of(usage):
    return {"vgprs": round_up(usage.vgprs, VGPR_BLOCK), "sgprs": round_up(usage.sgprs, SGPR_BLOCK),
            "local_bytes": usage.local_bytes, "waves_per_simd": usage.waves_per_simd}


def over_budget(usage, budget):
    """Where a kernel uses more than its budget, a dict as of budget_of or None."""
    if budget is None:
        return ["budget: none stored, add one with --update-budget"]
    found = [f"budget: {getattr(usage, name)} {name}, at most {budget[name]} allowed"
             for name in ("vgprs", "sgprs", "local_bytes") if getattr(usage, name) > budget[name]]
    if usage.waves_per_simd < budget["waves_per_simd"]:
        found.append(f"budget: {usage.waves_per_simd} waves_per_simd, at least {budget['waves_per_simd']} expected")
    return found


def read_budget(path):
    """{kernel variant: {target: budget}}; empty where there is no file."""
    return json.loads(path.read_text(encoding="utf-8"))["kernels"] if path.exists() else {}


def read_sources(path):
    """sources_hash() of the kernels that the budget was written for; None where there is no file."""
    return json.loads(path.read_text(encoding="utf-8")).get("sources") if path.exists() else None


def write_budget(path, compiler, sources, results):
    """One line a target, so that a difference reads well. `results` is {kernel variant: {target: Usage}}."""
    kernels = []
    for key in sorted(results):
        targets = [f'   "{target}": {json.dumps(budget_of(usage))}' for target, usage in results[key].items()]
        kernels.append(f'  "{key}": {{\n' + ",\n".join(targets) + "\n  }")
    path.write_text(f'{{\n "compiler": {json.dumps(compiler)},\n "sources": {json.dumps(sources)},\n "kernels": {{\n' + ",\n".join(kernels) + "\n }\n}\n",
                    encoding="utf-8")
