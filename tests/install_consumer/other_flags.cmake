# Builds other_flags/ with apsl as a subdirectory, runs it, and installs it: its own program, and nothing of apsl's.
# Debug: there std::isfinite is a function that the linker may exchange.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/other_flags -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
  -DAPSL_SOURCE=${APSL_SOURCE} -DCMAKE_C_FLAGS=${FLAGS} -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_INSTALL_BINDIR=bin)
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${WORK}/build/other_flags)
run(${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/prefix)
file(GLOB_RECURSE installed RELATIVE ${WORK}/prefix ${WORK}/prefix/*)
if(NOT installed STREQUAL "bin/other_flags")
  message(FATAL_ERROR "a project with apsl as a subdirectory installed ${installed}, expected its own bin/other_flags alone")
endif()
