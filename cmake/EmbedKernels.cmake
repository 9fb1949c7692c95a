# Run as a script at build time: writes OUTPUT, a C++ source that holds FILES (names below DIRECTORY, separated by |) as
# bytes. Hex rather than string literals: nothing to escape, no limit on length. Constant expressions: a limiter in a global
# object may need them before this file's dynamic initialisation. HEADER declares kernel_sources() in NAMESPACE.
string(REPLACE "|" ";" files "${FILES}")
set(arrays "")
set(table "")
foreach(file IN LISTS files)
  file(READ "${DIRECTORY}/${file}" bytes HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
  string(MAKE_C_IDENTIFIER "${file}" name)
  string(APPEND arrays "constexpr char ${name}[] = {${bytes}};\n")
  string(APPEND table "    {\"${file}\", {${name}, sizeof ${name}}},\n")
endforeach()
file(WRITE "${OUTPUT}.new" "// Made by cmake/EmbedKernels.cmake.
#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {

${arrays}
constexpr apsl::host::KernelSource sources[] = {
${table}};

}  // namespace

std::span<const apsl::host::KernelSource> kernel_sources() {
    return sources;
}

}  // namespace ${NAMESPACE}
")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
