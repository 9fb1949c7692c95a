# Installs the library and what find_package(apsl) needs. The program and its scenes come along where they were built.
include(CMakePackageConfigHelpers)

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/apsl)

set_target_properties(apsl_core PROPERTIES EXPORT_NAME core)
install(TARGETS apsl apsl_core EXPORT apsl-targets)
if(APSL_BUILD_REFERENCE)
  # A file of its own: whoever wants the library alone needs no Eigen.
  set_target_properties(apsl_reference PROPERTIES EXPORT_NAME reference)
  install(TARGETS apsl_reference EXPORT apsl-reference-targets)
  install(EXPORT apsl-reference-targets NAMESPACE apsl:: DESTINATION ${package_directory})
endif()
install(EXPORT apsl-targets NAMESPACE apsl:: DESTINATION ${package_directory})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/apsl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/apsl-config.cmake.in
  ${PROJECT_BINARY_DIR}/apsl-config.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/apsl-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/apsl-config.cmake ${PROJECT_BINARY_DIR}/apsl-config-version.cmake
  DESTINATION ${package_directory})
