# SPDX-License-Identifier: MIT
"""The compiler's assembly text, taken apart: instructions, branch targets, arguments and the kernel descriptor."""
import re
from dataclasses import dataclass, field
from functools import lru_cache


class UnknownInstruction(Exception):
    """Something of the machine that is not modelled here; the text names the instruction."""


@dataclass
class Instruction:
    text: str
    mnemonic: str
    operands: tuple  # texts
    modifiers: dict  # {"offset": "16", "glc": ""}
    target: int = -1  # of a branch: the place of the next instruction
    executed: int = 0  # by how many waves
    action: object = None  # what the instruction does to a wave; decoded when it is first executed


@dataclass(frozen=True)
class Argument:
    kind: str  # global_buffer, by_value, hidden_block_count_x …
    offset: int  # bytes, in the block of arguments
    size: int  # bytes
    type_name: str
    name: str


@dataclass
class Kernel:
    name: str
    instructions: list
    arguments: list
    argument_bytes: int
    local_bytes: int
    scratch_bytes: int
    descriptor: dict = field(default_factory=dict)  # {"user_sgpr_count": 14}, of the .amdhsa_ directives


# Two names of one instruction: that of GCN and CDNA, or of RDNA 4, and that of RDNA 2 and 3, which is used here.
_SAME = {
    "v_max_num_f32": "v_max_f32", "v_min_num_f32": "v_min_f32", "v_minmax_num_f32": "v_minmax_f32",
    "v_maxmin_num_f32": "v_maxmin_f32", "v_med3_num_f32": "v_med3_f32", "v_mad_co_u64_u32": "v_mad_u64_u32",
    "s_max_num_f32": "s_max_f32", "s_min_num_f32": "s_min_f32",
    "v_max3_num_f32": "v_max3_f32", "v_min3_num_f32": "v_min3_f32",
    "s_add_co_u32": "s_add_u32", "s_add_co_ci_u32": "s_addc_u32", "s_add_co_i32": "s_add_i32",
    "s_sub_co_u32": "s_sub_u32", "s_sub_co_ci_u32": "s_subb_u32", "s_sub_co_i32": "s_sub_i32",
    "s_andn2_b32": "s_and_not1_b32", "s_andn2_b64": "s_and_not1_b64", "s_orn2_b32": "s_or_not1_b32",
    "s_orn2_b64": "s_or_not1_b64", "s_andn2_saveexec_b32": "s_and_not1_saveexec_b32",
    "s_andn2_saveexec_b64": "s_and_not1_saveexec_b64", "s_ff1_i32_b32": "s_ctz_i32_b32",
    "v_add_u32": "v_add_nc_u32", "v_sub_u32": "v_sub_nc_u32", "v_subrev_u32": "v_subrev_nc_u32",
    "v_addc_co_u32": "v_add_co_ci_u32", "v_subb_co_u32": "v_sub_co_ci_u32", "v_add_i32": "v_add_nc_i32",
    "v_lshl_b64": "v_lshlrev_b64",
}
_WORDS = {"dword": "b32", "dwordx2": "b64", "dwordx3": "b96", "dwordx4": "b128", "dwordx8": "b256",
          "dwordx16": "b512", "ushort": "u16", "ubyte": "u8", "sshort": "i16", "sbyte": "i8", "short": "b16",
          "byte": "b8"}


@lru_cache(maxsize=None)
def common_name(mnemonic):
    """The one name here for an instruction: without its encoding, as RDNA 3 calls it."""
    name = re.sub(r"_(e32|e64|sdwa)$", "", mnemonic)
    if memory := re.fullmatch(r"((?:global|s)_(?:load|store))_(\w+)", name):
        return f"{memory[1]}_{_WORDS.get(memory[2], memory[2])}"
    if local := re.fullmatch(r"ds_(read|write)(2st64|2)?_(b\d+|u16|u8|i16|i8)", name):
        apart = {"2": "_2addr", "2st64": "_2addr_stride64", None: ""}[local[2]]
        return f"ds_{'load' if local[1] == 'read' else 'store'}{apart}_{local[3]}"
    return _SAME.get(name, name)


def _split(text, separator):
    """Parts of a text between separators that stand outside of brackets."""
    if "[" not in text and "(" not in text:
        return [part.strip() for part in text.split(separator) if part.strip()]
    parts, depth = [""], 0
    for character in text:
        depth += (character in "[(") - (character in "])")
        if character == separator and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part.strip()]


def parse_instruction(text):
    """One instruction; of a pair that is issued together (`::`) one half at a time."""
    mnemonic, _, rest = text.partition(" ")
    operands, modifiers = [], {}
    parts = _split(rest, ",")
    for part in parts:
        operand, *words = _split(part, " ")
        # A waitcnt and a few more have no operands but words.
        operands.append(operand)
        for word in words:
            name, _, value = word.partition(":")
            modifiers[name] = value
    return Instruction(text, mnemonic, tuple(operands), modifiers)


def _body(lines):
    """Instructions of a function's lines; branches know the place of their label."""
    instructions, labels = [], {}
    for line in lines:
        line = line.split(";")[0].rstrip()
        if line.startswith("\t"):
            if not line.startswith("\t."):
                instructions.append(parse_instruction(line.strip()))
        elif line.endswith(":"):
            labels[line[:-1]] = len(instructions)
    for instruction in instructions:
        if instruction.mnemonic.startswith(("s_branch", "s_cbranch")):
            instruction.target = labels[instruction.operands[0]]
    return instructions


def _arguments(entry):
    block = entry.split(".args:", 1)[1].split("\n    .", 1)[0]
    found = []
    for text in re.split(r"^      - ", block, flags=re.MULTILINE)[1:]:
        fields = dict(re.findall(r"\.(\w+): +(.*)$", text, re.MULTILINE))
        found.append(Argument(fields["value_kind"], int(fields["offset"]), int(fields["size"]),
                              fields.get("type_name", "").strip("'"), fields.get("name", "")))
    return found


def kernels_of(assembly):
    """{name: Kernel} of a file."""
    metadata = assembly.split(".amdgpu_metadata", 1)[1].split(".end_amdgpu_metadata", 1)[0]
    listed = metadata.split("amdhsa.kernels:", 1)[1].split("\namdhsa.", 1)[0]
    kernels = {}
    for entry in re.split(r"^  - ", listed, flags=re.MULTILINE)[1:]:
        entry = "    " + entry
        fields = dict(re.findall(r"^ {4}\.(\w+): +(\S+)$", entry, re.MULTILINE))
        name = fields["name"]
        body = assembly.split(f"\n{name}:", 1)[1].split("\n.Lfunc_end", 1)[0]
        code, directives = body.split(f"\t.amdhsa_kernel {name}\n", 1)
        directives = directives.split(".end_amdhsa_kernel", 1)[0]
        descriptor = {key: int(value, 0)
                      for key, value in re.findall(r"^\t\t\.amdhsa_(\w+) (\w+)$", directives, re.MULTILINE)}
        kernels[name] = Kernel(name, _body(code.splitlines()[1:]), _arguments(entry),
                               int(fields["kernarg_segment_size"]), int(fields["group_segment_fixed_size"]),
                               int(fields["private_segment_fixed_size"]), descriptor)
    return kernels
