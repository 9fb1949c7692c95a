# Builds the shared library with debug information in SHARED_BUILD, and installs it and the static one of APSL_BUILD into a
# folder each below PREFIXES. The folders are then moved: nothing installed may know where it was installed to.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(${CMAKE_COMMAND} -S ${APSL_SOURCE} -B ${SHARED_BUILD} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=RelWithDebInfo
  -DCMAKE_INSTALL_PREFIX=/usr
  -DBUILD_SHARED_LIBS=ON -DAPSL_BUILD_TESTS=OFF -DAPSL_BUILD_COMPARE=OFF -DAPSL_BUILD_PROGRAM=OFF
  -DAPSL_BUILD_REFERENCE=OFF -DAPSL_WARNINGS_AS_ERRORS=ON)
run(${CMAKE_COMMAND} --build ${SHARED_BUILD} --parallel 2)
if(PREFIXES)
  file(REMOVE_RECURSE ${PREFIXES})
  foreach(linkage static shared)
    set(tree ${APSL_BUILD})
    if(linkage STREQUAL "shared")
      set(tree ${SHARED_BUILD})
    endif()
    foreach(component runtime development)
      run(${CMAKE_COMMAND} --install ${tree} --component ${component} --prefix ${PREFIXES}/installed_${linkage})
    endforeach()
    file(RENAME ${PREFIXES}/installed_${linkage} ${PREFIXES}/${linkage})
  endforeach()
endif()
