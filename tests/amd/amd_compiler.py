# SPDX-License-Identifier: MIT
"""One OpenCL file to AMD machine code with clang, and what the result uses. No GPU is needed."""
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path


class CompileError(Exception):
    """clang refused the file or warned about it; the text is what it said."""


@dataclass(frozen=True)
class Usage:
    """What one kernel uses, from the metadata, the remarks and the instructions of the compiler's output."""
    kernel: str
    wave_size: int  # lanes
    vgprs: int  # vector registers a lane
    sgprs: int  # scalar registers a wave
    local_bytes: int  # local memory (LDS) a work-group
    waves_per_simd: int  # that registers and local memory leave room for
    scratch_bytes: int  # private memory a lane, in device memory
    vgpr_spills: int
    sgpr_spills: int
    instructions: frozenset  # mnemonics


def version(clang):
    return subprocess.run([clang, "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0]


def _device_libraries(folder, target):
    wave_size_64 = "on" if target.wave_size == 64 else "off"
    # Where host/ asks for nothing else, AMD's OpenCL links the same: no daz, no unsafe math, fast square root.
    names = ["opencl", "ocml", "ockl", f"oclc_isa_version_{target.isa}", f"oclc_wavefrontsize64_{wave_size_64}",
             "oclc_abi_version_500", "oclc_correctly_rounded_sqrt_off", "oclc_daz_opt_off", "oclc_finite_only_off",
             "oclc_unsafe_math_off"]
    return [word for name in names for word in ("-Xclang", "-mlink-builtin-bitcode", "-Xclang", f"{folder / name}.bc")]


def compile_source(clang, device_libraries, source, defines, target):
    """Assembly text of the file's kernels, and the compiler's remarks. Raises CompileError."""
    command = [clang, "-x", "cl", "-cl-std=CL1.2", "-target", "amdgcn-amd-amdhsa", f"-mcpu={target.processor}", "-O3",
               "-S", "-o", "-", "-Wall", "-Wextra", "-Wundef", "-Werror", "-Rpass-analysis=kernel-resource-usage",
               "-fno-caret-diagnostics", "-nogpulib", "-mcode-object-version=5", "-cl-kernel-arg-info",
               f"-I{source.parent}"]
    if target.wave_size == 64 and int(target.processor[3:], 16) >= 0x1000:  # RDNA, which else compiles for 32 lanes
        command.append("-mwavefrontsize64")
    command += _device_libraries(Path(device_libraries), target)
    command += [f"-D{name}={value}" for name, value in defines] + [str(source)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    if result.returncode != 0:
        lines = [line for line in result.stderr.splitlines() if "remark:" not in line]
        raise CompileError("\n".join(lines))
    return result.stdout, result.stderr


def compile_kernels(clang, device_libraries, source, defines, target):
    """A list of Usage, one for each kernel of the file. Raises CompileError."""
    return _usages(*compile_source(clang, device_libraries, source, defines, target))


def _usages(assembly, remarks):
    metadata = assembly.split(".amdgpu_metadata", 1)[1].split(".end_amdgpu_metadata", 1)[0]
    kernels = metadata.split("amdhsa.kernels:", 1)[1].split("\namdhsa.", 1)[0]
    waves = dict(re.findall(r"Function Name: (\w+).*?Occupancy \[waves/SIMD\]: (\d+)", remarks, re.DOTALL))
    instructions = _instructions(assembly)
    usages = []
    for entry in re.split(r"^  - ", kernels, flags=re.MULTILINE)[1:]:
        # Fields of the kernel itself are indented by four blanks (the first by none); those of its arguments by more.
        fields = dict(re.findall(r"^(?: {4})?\.(\w+): +(\S+)$", entry, re.MULTILINE))
        name = fields["name"]
        usages.append(Usage(name, int(fields["wavefront_size"]), int(fields["vgpr_count"]), int(fields["sgpr_count"]),
                            int(fields["group_segment_fixed_size"]), int(waves[name]),
                            int(fields["private_segment_fixed_size"]), int(fields["vgpr_spill_count"]),
                            int(fields["sgpr_spill_count"]), frozenset(instructions[name])))
    return usages


def _instructions(assembly):
    """Mnemonics of each function."""
    functions = {}
    mnemonics = set()
    for line in assembly.splitlines():
        if label := re.match(r"([A-Za-z_]\w*):", line):
            mnemonics = functions.setdefault(label.group(1), set())
        elif instruction := re.match(r"\s+([a-z]\w*)", line):
            mnemonics.add(instruction.group(1))
    return functions
