# What a plain `cmake -S . -B build` should do; a project that embeds this one decides for itself.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Spelled out for every target, because clang-tidy reads the flags with another default than GCC's.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

find_program(STEREOMOTION_CCACHE ccache)
mark_as_advanced(STEREOMOTION_CCACHE)
if(STEREOMOTION_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${STEREOMOTION_CCACHE})
endif()
