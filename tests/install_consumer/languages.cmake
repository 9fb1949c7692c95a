# The headers with what a program may be compiled as: C89 and strict, an older C++ for the C interface, C++20 without
# exceptions. An older C++ with the C++ headers ends in one line that says what is needed.
cmake_minimum_required(VERSION 3.25)

set(warnings -Wall -Wextra -pedantic-errors -Werror -DCL_TARGET_OPENCL_VERSION=120 -I${APSL_SOURCE}/include -fsyntax-only)
function(compile source)  # compile(source COMMAND...)
  file(WRITE ${WORK}/${source} "${content}")
  execute_process(COMMAND ${ARGN} ${warnings} ${WORK}/${source} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(MAKE_DIRECTORY ${WORK})
set(content "#include <apsl/apsl.h>\nint main(void) { return apsl_version_number() != APSL_VERSION_NUMBER; }\n")
foreach(standard c89 c99 c11 c17)
  compile(c_interface.c ${C_COMPILER} -std=${standard})
endforeach()
foreach(standard c++11 c++17 c++20)
  compile(c_interface.cpp ${CXX_COMPILER} -std=${standard})
endforeach()

set(headers error parameters reference stats strain_limiter topology)
foreach(header IN LISTS headers)
  set(content "#include <apsl/${header}.hpp>\nint main() {}\n")
  compile(${header}.cpp ${CXX_COMPILER} -std=c++20 -fno-exceptions -fno-rtti)
  execute_process(COMMAND ${CXX_COMPILER} -std=c++17 ${warnings} ${WORK}/${header}.cpp
    RESULT_VARIABLE result ERROR_VARIABLE output)
  string(REGEX MATCHALL "error: [^\n]*" errors "${output}")
  list(LENGTH errors count)
  if(result EQUAL 0 OR NOT output MATCHES "error: [^\n]*apsl needs C\\+\\+20" OR count GREATER 2)
    message(FATAL_ERROR "<apsl/${header}.hpp> as C++17, expected the line that asks for C++20 and an end:\n${output}")
  endif()
endforeach()
