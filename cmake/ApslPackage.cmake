# Debian packages by CPack: the shared library, what embedding programs need, and the program with its scenes.
# cmake/make_debs.sh makes them.
find_program(DPKG_EXECUTABLE dpkg)
find_program(GZIP_EXECUTABLE gzip)
if(NOT DPKG_EXECUTABLE OR NOT GZIP_EXECUTABLE)
  return()
endif()
set(apsl_library_package libapsl${PROJECT_VERSION_MAJOR})

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

set(apsl_description "Keeps simulated cloth from over-stretching: after each time step it corrects
the vertex velocities so that triangles stay near their rest area")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${apsl_library_package})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers ${PROJECT_BINARY_DIR}/debian/shlibs)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${apsl_description}.
This package holds the shared library.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libapsl-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "${apsl_library_package} (= ${PROJECT_VERSION}-1), ocl-icd-opencl-dev, opencl-c-headers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS libeigen3-dev)  # apsl::reference
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${apsl_description}.
This package holds the headers, the static library, and what CMake and
pkg-config need to find them.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME apsl)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${apsl_library_package} (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${apsl_description}.
This package holds the program apsl, which runs scenes of cloth, reports what
area change is left and writes frames for ParaView and Blender, and example
scenes in /usr/share/apsl/scenes.")

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
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH where it is set
file(WRITE ${PROJECT_BINARY_DIR}/debian/changelog.Debian "apsl (${PROJECT_VERSION}-1) unstable; urgency=medium

  * Changes are in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_BINARY_DIR}/debian/changelog COPYONLY)
execute_process(COMMAND ${GZIP_EXECUTABLE} -9nf changelog changelog.Debian WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/debian
  COMMAND_ERROR_IS_FATAL ANY)
foreach(package IN ITEMS ${apsl_library_package}=runtime libapsl-dev=development apsl=program)
  string(REGEX MATCH "^(.*)=(.*)$" package "${package}")
  foreach(file copyright changelog.gz changelog.Debian.gz)
    install(FILES ${PROJECT_BINARY_DIR}/debian/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CMAKE_MATCH_1}
      COMPONENT ${CMAKE_MATCH_2} EXCLUDE_FROM_ALL)
  endforeach()
endforeach()

include(CPack)
