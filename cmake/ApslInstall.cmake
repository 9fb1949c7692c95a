# Installs the library and what find_package(apsl) and pkg-config need. The program and its scenes come along where they
# were built. The static and the shared library may be installed to one place, from a build tree each.
include(CMakePackageConfigHelpers)

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/apsl)
set(linkage static)
set(libraries apsl apsl_core)
if(BUILD_SHARED_LIBS)
  set(linkage shared)
  set(libraries apsl)
endif()

set_target_properties(apsl_core PROPERTIES EXPORT_NAME core)
install(TARGETS ${libraries} EXPORT apsl-targets
  RUNTIME COMPONENT runtime
  LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
  ARCHIVE COMPONENT development)
install(EXPORT apsl-targets NAMESPACE apsl:: FILE apsl-${linkage}-targets.cmake DESTINATION ${package_directory}
  COMPONENT development)
if(APSL_BUILD_REFERENCE)
  # A file of its own: whoever wants the library alone needs no Eigen.
  set_target_properties(apsl_reference PROPERTIES EXPORT_NAME reference)
  install(TARGETS apsl_reference EXPORT apsl-reference-targets ARCHIVE COMPONENT development)
  install(EXPORT apsl-reference-targets NAMESPACE apsl:: FILE apsl-${linkage}-reference-targets.cmake
    DESTINATION ${package_directory} COMPONENT development)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/apsl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/apsl-config.cmake.in
  ${PROJECT_BINARY_DIR}/apsl-config.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/apsl-config-version.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/apsl-config.cmake ${PROJECT_BINARY_DIR}/apsl-config-version.cmake
  DESTINATION ${package_directory} COMPONENT development)

# The prefix is told from where the file lies, so that the installed tree can be moved.
file(RELATIVE_PATH apsl_prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" apsl_prefix_from_pkgconfig "${apsl_prefix_from_pkgconfig}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/apsl.pc.in ${PROJECT_BINARY_DIR}/apsl.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/apsl.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
