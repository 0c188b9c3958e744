# `cpack` in the build folder: stereomotion.deb (the program) and libstereomotion-dev.deb.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The stereomotion authors <stereomotion@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # the program's libraries, from its ELF header
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME stereomotion)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "The program. Measures from two calibrated cameras where a body that carries rods of
retro-reflective balls is and how it is turned, with an uncertainty on every number.")

# What cmake/stereomotionConfig.cmake.in looks for.
set(library_packages libeigen3-dev libopencv-dev libyaml-cpp-dev libtomlplusplus-dev
    nlohmann-json3-dev libfmt-dev libspdlog-dev libssl-dev zlib1g-dev libapriltag-dev libceres-dev
    libaravis-dev libusb-1.0-0-dev libhdf5-dev pkg-config)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libstereomotion-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
list(JOIN library_packages ", " depends)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ${depends})
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The library: headers, static libraries and what find_package(stereomotion) reads.")

include(CPack)
