# Gives a target the project's warnings.
function(stereomotion_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                         -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual)
  if(STEREOMOTION_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# Adds one layer, installed and exported as stereomotion::NAME:
# stereomotion_layer(NAME SOURCES … PUBLIC layers-and-libraries… PRIVATE libraries…)
# A library named here must also be found by cmake/stereomotionConfig.cmake.in: a static library
# hands even its PRIVATE libraries on to whoever links it.
function(stereomotion_layer name)
  cmake_parse_arguments(LAYER "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target stereomotion_${name})
  add_library(${target} STATIC ${LAYER_SOURCES})
  add_library(stereomotion::${name} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF
                        EXPORT_NAME ${name})
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${LAYER_PUBLIC} PRIVATE ${LAYER_PRIVATE})
  stereomotion_warnings(${target})
  install(TARGETS ${target} EXPORT stereomotionTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endfunction()
