# Debian packages by CPack: the shared library, what embedding programs need, and the program with its scenes.
# cmake/debian_package.sh makes them.
set(apsl_library_package libapsl${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(apsl_library_package libapsl0.${PROJECT_VERSION_MINOR})
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME apsl)
set(CPACK_PACKAGE_VENDOR "the apsl authors")
set(CPACK_PACKAGE_CONTACT "the apsl authors <apsl@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL runtime development)
if(APSL_BUILD_PROGRAM)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/host)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${apsl_library_package})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers ${PROJECT_BINARY_DIR}/debian/shlibs)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "area preserving strain limiting for cloth on OpenCL
 Keeps simulated cloth from over-stretching: after each time step it corrects the
 vertex velocities so that triangles stay near their rest area.
 This package holds the shared library.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libapsl-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "${apsl_library_package} (= ${PROJECT_VERSION}-1), ocl-icd-opencl-dev, opencl-c-headers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "area preserving strain limiting for cloth on OpenCL (development)
 Keeps simulated cloth from over-stretching: after each time step it corrects the
 vertex velocities so that triangles stay near their rest area.
 This package holds headers, the static library, and what CMake and pkg-config need.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME apsl)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${apsl_library_package} (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "simulate cloth with area preserving strain limiting
 Runs scenes of cloth with and without strain limiting, reports what area change is
 left, and writes frames for ParaView and Blender. Example scenes lie in
 /usr/share/apsl/scenes.")

# What Debian expects beside the files themselves.
file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
string(REPLACE libapsl "" soversion ${apsl_library_package})
file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs
  "libapsl ${soversion} ${apsl_library_package} (>= ${PROJECT_VERSION})\n")
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
string(REGEX REPLACE "^MIT License\n\n(Copyright[^\n]*)\n\n" "" license "${license}")
set(copyright "${CMAKE_MATCH_1}")
string(REPLACE "\n\n" "\n.\n" license "${license}")
string(STRIP "${license}" license)
string(REPLACE "\n" "\n " license "${license}")
string(REPLACE "Copyright (c) " "" copyright "${copyright}")
file(WRITE ${PROJECT_BINARY_DIR}/debian/copyright
  "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: apsl

Files: *
Copyright: ${copyright}
License: Expat

License: Expat
 ${license}
")
foreach(package IN ITEMS "${apsl_library_package};runtime" "libapsl-dev;development" "apsl;program")
  list(GET package 0 name)
  list(GET package 1 component)
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

include(CPack)
