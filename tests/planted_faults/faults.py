# SPDX-License-Identifier: MIT
"""The faults that planted_faults.py puts into a copy of the sources, one at a time, and the check that must see each."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """A command in the copy's root. `target`: what is built for it, of `preset`; none for a script."""
    name: str
    command: tuple
    preset: str = ""
    target: str = ""


@dataclass(frozen=True)
class Fault:
    what: str
    file: str
    old: str  # stands in the file exactly once
    new: str
    check: Check
    says: str  # a regular expression in the output of the failed check


def catch(name, preset, program, folder, selection, environment=()):
    return Check(name, ("env", *environment, f"build/{preset}/tests/{folder}/{program}", selection), preset, program)


def ctest(name, preset, target, pattern):
    return Check(name, ("ctest", "--preset", preset, "--output-on-failure", "-R", pattern), preset, target)


def oclgrind(name, program, folder, selection, uninitialized="0"):
    return Check(name, ("cmake", f"-DPROGRAM=build/ci/tests/{folder}/{program}", f"-DTESTS={selection}",
                        "-DOCLGRIND=/usr/lib/oclgrind/liboclgrind-rt-icd.so", f"-DUNINITIALIZED={uninitialized}",
                        "-DLOG=build/oclgrind.log", "-P", "tests/implementations/oclgrind.cmake"), "ci", program)


KERNEL_TESTS = ("ci", "apsl_kernel_tests", "kernels")
FILTER_TESTS = ("ci", "apsl_filter_tests", "filter")
SCENE_TESTS = ("ci", "scenes_test", "scenes")
OCLGRIND_FILTER = oclgrind("Oclgrind, bounds", "apsl_filter_tests", "filter", "[scalar]")
OCLGRIND_RACES = oclgrind("Oclgrind, races", "apsl_kernel_tests", "kernels", "[end_call]")
OCLGRIND_VALUES = oclgrind("Oclgrind, uninitialised values", "apsl_kernel_tests", "kernels",
                           "gather_displacements: keeps the greatest residual*", "1")
ASAN_EMBED = ctest("AddressSanitizer", "asan-library", "apsl_embed_tests", "apsl_embed_tests: ?the C interface does")
LEAKS_EMBED = ctest("LeakSanitizer", "asan-library", "apsl_embed_tests", "apsl_embed_tests: ?the C interface: every")
UBSAN_EMBED = ctest("UndefinedBehaviorSanitizer", "asan-library", "apsl_embed_tests", "apsl_embed_tests: ?scratch_bytes")
TSAN = ctest("ThreadSanitizer", "tsan", "apsl_thread_tests", "apsl_thread_tests: ?the C interface")

FAULTS = (
    Fault("a swapped index: two corners of a triangle store the same gradient",
          "kernels/triangle_assembly.h", "pack_gradient(cross_product(triangle.normal, triangle.edge[1])",
          "pack_gradient(cross_product(triangle.normal, triangle.edge[2])",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[assemble_gradients]"), r"FAILED"),
    Fault("a lost sign: vertices move against the total_correction",
          "kernels/vertex_motion.h", "x - sqrt(2.0f * x.w)", "x + sqrt(2.0f * x.w)",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[gather_displacements]"), r"FAILED"),
    Fault("small steps: the error of the start is not led back, but undone in the first part of the step",
          "kernels/small_steps.h",
          "return planned > 0 ? (float)planned / (float)small_steps : 0.0f;",
          "return 0.0f;",
          catch("filter against the reference", *FILTER_TESTS, "the filter agrees with the reference: small steps from*"),
          r"FAILED"),
    Fault("small steps: a triangle may be asked for any growth",
          "kernels/triangle_assembly.h", "excess = select(excess, least, excess < least);", "(void)least;",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[assemble_gradients]"), r"FAILED"),
    Fault("stretch ceiling: the multiplier of a stretch row is not kept at or above zero",
          "kernels/chebyshev_step.cl", "next[s] = fmax(", "next[s] = fma(1.0f, ",
          catch("kernel tests against the reference", *KERNEL_TESTS, "chebyshev_step with stretch rows*"), r"FAILED"),
    Fault("stretch ceiling: the stretch row is not made orthogonal to the area row",
          "kernels/stretch_rows.h", "t.area > 0.0f && t.diagonal > 0.0f", "t.area < 0.0f",
          catch("kernel tests against the reference", *KERNEL_TESTS, "stretch rows: gradients*"), r"FAILED"),
    Fault("stretch ceiling: a weak row is asked for all that it demands",
          "kernels/stretch_rows.h", "return fmin(value, share * share * value);", "return value + 0.0f * share;",
          catch("filter against the reference", *FILTER_TESTS, "a whole step: what starts far over*"), r"FAILED"),
    Fault("stretch ceiling: a row that pinned corners leave next to nothing is not weak",
          "kernels/stretch_rows.h", "fmin(movable * size, all * left)", "fmin(movable * size, 0.0f) + all * left",
          catch("stand-alone scenes", *SCENE_TESTS, "pins of one triangle that part*"), r"FAILED"),
    Fault("stretch ceiling: an area row between pins that come near to one another is not weak",
          "kernels/stretch_rows.h", "select(share * share * excess, excess, least > 0.0f)", "excess + 0.0f * share * least",
          catch("kernel tests against the reference", *KERNEL_TESTS, "stretch rows: gradients*"), r"FAILED"),
    Fault("stretch ceiling: tension adds no mass",
          "kernels/effective_mass.h",
          "1.0f / (1.0f / given + APSLK_MASS_ADDED_PER_STIFFNESS * stiffness)",
          "given + 0.0f * stiffness",
          catch("filter against the reference", *FILTER_TESTS, "stretch ceiling: the device agrees*"), r"FAILED"),
    Fault("stretch ceiling: added mass carries on with all its velocity",
          "kernels/effective_mass.h", "return fmin(1.0f, APSLK_AIMED_MASS_RATIO * effective / given);", "return 1.0f;",
          catch("filter against the reference", *FILTER_TESTS, "a whole step: mass that tension adds*"), r"FAILED"),
    Fault("a whole step: the step without a limit has the parts that the device raised",
          "kernels/free_motion.h", "max(parameters->given_small_steps, 1)", "max(parameters->small_steps, 1)",
          catch("filter against the reference", *FILTER_TESTS, "a whole step: where the limit is*"), r"FAILED"),
    Fault("energy: corrections leave a cloth with all the velocity that they make",
          "kernels/energy_bound.h", "if (!(of.left >", "if (of.left > 0.0f || !(of.left >",
          catch("filter against the reference", *FILTER_TESTS, "a whole step: a cloth at pins that stand still*"), r"FAILED"),
    Fault("energy: what acceleration gives to the step without a limit counts, wherever the cloth went",
          "kernels/measure_energy.cl", "before += free_energy + followed / step.w;", "before += free_energy + 0.0f * followed;",
          catch("kernel tests against the reference", *KERNEL_TESTS, "measure_energy*"), r"FAILED"),
    Fault("energy: a vertex that gained is slowed in the direction that it was thrown",
          "kernels/energy_bound.h", "velocity = free_velocity + kept.gain * (velocity - free_velocity);", "velocity = drive + kept.gain * (velocity - drive);",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[store_step]"), r"FAILED"),
    Fault("energy: friction drags as far as the body goes, however little it presses",
          "kernels/energy_bound.h", "fmin(drag, slip +", "fmin(drag, 1e9f + slip +",
          catch("kernel tests against the reference", *KERNEL_TESTS, "measure_energy*"), r"FAILED"),
    Fault("energy: what hinges hold does not count",
          "kernels/bend_hinges.cl", "energy += 0.5f * moment * moment;", "energy += 0.0f * moment;",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[bend_hinges]"), r"FAILED"),
    Fault("energy: a body counts however far away it is",
          "kernels/energy_bound.h", "gap <= time_step * length(velocity - body)", "gap <= 1e9f + time_step * length(velocity - body)",
          catch("kernel tests against the reference", *KERNEL_TESTS, "measure_energy*"), r"FAILED"),
    Fault("energy: of velocities as they are, not in the frame of what drives the cloth",
          "kernels/measure_energy.cl", "limited = step.xyz / time_step - drive.velocity;", "limited = step.xyz / time_step;",
          catch("kernel tests against the reference", *KERNEL_TESTS, "measure_energy*"), r"FAILED"),
    Fault("acceleration of each vertex: the limiter's order of vertices is taken for the caller's",
          "kernels/vertex_motion.h", "load_position(accelerations, vertex_order[place])", "load_position(accelerations, place)",
          catch("kernel tests against the reference", *KERNEL_TESTS, "acceleration in predict_positions*"), r"FAILED"),
    Fault("tethers: the limiter's order of vertices is taken for the caller's",
          "kernels/vertex_motion.h", "tethers, cloth, touched.vertex_order[i])", "tethers, cloth, i)",
          catch("filter against the reference", *FILTER_TESTS, "tethers: the device agrees*"), r"FAILED"),
    Fault("tethers: an anchor that is not pinned holds all the same",
          "kernels/tethers.h", "APSLK_INVERSE_MASS_STRIDE] == 0.0f", "APSLK_INVERSE_MASS_STRIDE] >= 0.0f",
          catch("filter against the reference", *FILTER_TESTS, "tethers: an anchor that is not pinned*"), r"FAILED"),
    Fault("tethers: an anchor is taken to stay where the step began",
          "kernels/tethers.h", "load_velocity(tethers.velocities, anchor),\n                              time);",
          "load_velocity(tethers.velocities, anchor),\n                              0.0f * time);",
          catch("filter against the reference", *FILTER_TESTS, "tethers: the device agrees*"), r"FAILED"),
    Fault("masses are never raised",
          "kernels/effective_mass.h", "if (!(stiffness * given > APSLK_HELD_TENSION)) return given;",
          "if (greatest >= 0.0f) return given;",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[gather_displacements]"), r"FAILED"),
    Fault("the mass of a vertex that is light enough for its tension is not looked at",
          "kernels/vertex_motion.h", "effective < given || tension > small_step.held_tension", "effective < given",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[gather_displacements]"), r"FAILED"),
    Fault("a gradient of zero, which may get any direction, does not count in the bound of the matrix",
          "kernels/bound_matrix.cl", "greatest_eigenvalue(sums) + fmax(unknown, (lanes)(0.0f))",
          "greatest_eigenvalue(sums) + 0.0f * unknown",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[bound_vertices]"), r"FAILED"),
    Fault("a result is judged by area changes without a cap",
          "kernels/area_sums.h", "fmin(change, (lanes)(1.0f))", "change",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[measure_area_change]"), r"FAILED"),
    Fault("a group of 64 is taken to run in lockstep: the sum of its last two items lacks a barrier",
          "kernels/work_group.h",
          "        if (l < half_size) scratch[l] += scratch[l + half_size];\n        barrier(CLK_LOCAL_MEM_FENCE);",
          "        if (l < half_size) scratch[l] += scratch[l + half_size];\n"
          "        if (half_size > 1) barrier(CLK_LOCAL_MEM_FENCE);",
          OCLGRIND_RACES, r"(?i)data race"),
    Fault("an element past the end of a buffer is read",
          "kernels/vertex_motion.h",
          "    sums.drive = no_drive();\n#endif\n    for (uint v = range.first; v < range.end;",
          "    sums.drive = no_drive();\n#endif\n    for (uint v = range.first; v <= range.end;",
          OCLGRIND_FILTER, r"Invalid read"),
    Fault("local memory is read where half of it was never written",
          "kernels/work_group.h",
          "    scratch[l] = value;\n    barrier(CLK_LOCAL_MEM_FENCE);\n"
          "    for (uint half_size = APSLK_WORK_GROUP_SIZE / 2; half_size > 0; half_size >>= 1) {\n"
          "        if (l < half_size) scratch[l] += ",
          "    if (l < APSLK_WORK_GROUP_SIZE / 2) scratch[l] = value;\n    barrier(CLK_LOCAL_MEM_FENCE);\n"
          "    for (uint half_size = APSLK_WORK_GROUP_SIZE / 2; half_size > 0; half_size >>= 1) {\n"
          "        if (l < half_size) scratch[l] += ",
          OCLGRIND_VALUES, r"Uninitialized value"),
    Fault("four bytes past the end of a host array are uploaded",
          "host/device_arrays.cpp", "return memory.allocate(contents.size() * sizeof(Value), contents.data());",
          "return memory.allocate(contents.size() * sizeof(Value) + 4, contents.data());",
          ASAN_EMBED, r"heap-buffer-overflow"),
    Fault("a topology is never deleted", "host/c_interface.cpp",
          "void apsl_topology_destroy(apsl_topology* topology) {\n    delete topology;",
          "void apsl_topology_destroy(apsl_topology* topology) {\n    (void)topology;",
          LEAKS_EMBED, r"LeakSanitizer: detected memory leaks"),
    Fault("a shift past the width of its type", "src/csr_pattern.cpp", "code |= corner << (2 * k);",
          "code |= corner << (16 * k);", UBSAN_EMBED, r"runtime error: shift exponent 32"),
    Fault("an event is retained once too often", "host/kernel_launch.cpp",
          "    if (out_of_order_) previous_ = EventHandle(event);",
          "    if (out_of_order_) clRetainEvent(event);\n    if (out_of_order_) previous_ = EventHandle(event);",
          catch("counts of OpenCL references", "ci", "apsl_embed_tests", "embed", "an enqueue that fails*"),
          r"events"),
    Fault("the last error is shared between threads", "host/c_interface.cpp",
          "thread_local std::array<char, 4096> last_error{};", "static std::array<char, 4096> last_error{};",
          TSAN, r"ThreadSanitizer: data race"),
    Fault("a constant in double precision", "kernels/vertex_motion.h",
          "displacement * (1.0f / time_step)", "displacement * (float)(1.0000000001 / time_step)",
          Check("AMD gate", ("/usr/bin/python3", "tests/amd/check_kernels.py", "--jobs", "2")), r"double"),
    Fault("the filter corrects one part in a thousand too much", "kernels/vertex_motion.h",
          "displacement * (1.0f / time_step)", "displacement * (1.001f / time_step)",
          catch("kernel tests against the reference", *KERNEL_TESTS, "[update_velocities]"), r"FAILED"),
)
