# Builds the shared library with debug information in SHARED_BUILD, and installs it and the static one of APSL_BUILD below
# PREFIXES, alone and together. The folders are then moved: nothing installed may know where it was installed to.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(${CMAKE_COMMAND} -S ${APSL_SOURCE} -B ${SHARED_BUILD} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=RelWithDebInfo
  -DCMAKE_INSTALL_PREFIX=${INSTALL_PREFIX}
  -DBUILD_SHARED_LIBS=ON -DAPSL_BUILD_TESTS=OFF -DAPSL_BUILD_COMPARE=OFF -DAPSL_BUILD_PROGRAM=OFF
  -DAPSL_BUILD_REFERENCE=OFF -DAPSL_WARNINGS_AS_ERRORS=ON)
run(${CMAKE_COMMAND} --build ${SHARED_BUILD} --parallel 2)
if(PREFIXES)
  file(REMOVE_RECURSE ${PREFIXES})
  set(static_trees ${APSL_BUILD})
  set(shared_trees ${SHARED_BUILD})
  set(both_trees ${APSL_BUILD} ${SHARED_BUILD})
  foreach(prefix static shared both)
    foreach(tree IN LISTS ${prefix}_trees)
      foreach(component runtime development)
        run(${CMAKE_COMMAND} --install ${tree} --component ${component} --prefix ${PREFIXES}/installed_${prefix})
      endforeach()
    endforeach()
    file(RENAME ${PREFIXES}/installed_${prefix} ${PREFIXES}/${prefix})
  endforeach()
endif()
