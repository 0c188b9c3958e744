# `cmake --install`: headers, libraries, the program and what find_package(stereomotion) reads.
# Component `runtime` is the program, `development` the library; each becomes one Debian package.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/stereomotion)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/stereomotion
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(EXPORT stereomotionTargets NAMESPACE stereomotion:: DESTINATION ${package_dir}
        COMPONENT development)

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/stereomotionConfig.cmake.in
  ${PROJECT_BINARY_DIR}/stereomotionConfig.cmake INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 every minor version may break.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stereomotionConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/stereomotionConfig.cmake
              ${PROJECT_BINARY_DIR}/stereomotionConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)

# Debian's policy wants the licence of every package under its own name.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stereomotion
        RENAME copyright COMPONENT runtime)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libstereomotion-dev RENAME copyright
        COMPONENT development)
# The pages that the program's messages point to.
install(FILES ${PROJECT_SOURCE_DIR}/docs/formats.md ${PROJECT_SOURCE_DIR}/docs/conventions.md
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/stereomotion COMPONENT runtime)
if(EXISTS ${PROJECT_SOURCE_DIR}/calib)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/calib DESTINATION ${CMAKE_INSTALL_DATADIR}/stereomotion
          COMPONENT runtime)
endif()
