# SPDX-License-Identifier: Apache-2.0
# The renderer without what needs a library: no file formats, no command. So it can be built for processors for which
# Debian has a compiler but no libraries, and its tests run in an emulator (./check --targets).
include(CTest)

# Headers that hold all of their library are this machine's own; GoogleTest comes as source.
foreach(header fmt/format.h hwy/highway.h)
  get_filename_component(folder ${header} DIRECTORY)
  find_path(${folder}_headers ${header} PATHS /usr/include REQUIRED NO_CMAKE_FIND_ROOT_PATH)
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/headers)
  file(CREATE_LINK ${${folder}_headers}/${folder} ${CMAKE_CURRENT_BINARY_DIR}/headers/${folder} SYMBOLIC)
endforeach()
target_include_directories(zoneplate_flags SYSTEM INTERFACE ${CMAKE_CURRENT_BINARY_DIR}/headers)
target_compile_definitions(zoneplate_flags INTERFACE FMT_HEADER_ONLY)
if(EMSCRIPTEN) # whose popcount and countr_zero give what they are given
  target_compile_options(zoneplate_flags INTERFACE -Wno-sign-conversion)
endif()

# The rooms of the core are those that layers.txt lists before `os`.
file(STRINGS src/zoneplate/layers.txt rooms REGEX "^[a-z]")
list(FIND rooms os first_system_room)
list(SUBLIST rooms 0 ${first_system_room} core_rooms)
list(JOIN core_rooms "|" core_rooms)
set(package_kernels ${simd_sources})
list(FILTER package_kernels INCLUDE REGEX "^src/zoneplate/codec/")
foreach(list library_sources simd_sources test_sources)
  list(FILTER ${list} INCLUDE REGEX "^src/zoneplate/(${core_rooms})/[^/]*$|/generated/")
endforeach()
list(APPEND test_sources tests/pictures_test.cpp)

if(NOT BUILD_TESTING) # of the package for Node and browsers
  list(APPEND simd_sources ${package_kernels})
endif()
add_kernels("${simd_sources}")
add_library(zoneplate STATIC ${library_sources} ${kernel_objects})
target_link_libraries(zoneplate PUBLIC zoneplate_flags)
target_precompile_headers(zoneplate PRIVATE ${common_headers})
compile_folders_together(zoneplate)
if(NOT BUILD_TESTING)
  include(cmake/playground.cmake)
  if(NOT CMAKE_CXX_FLAGS MATCHES "-pthread")
    include(cmake/node.cmake)
  endif()
  return()
endif()

include(GoogleTest)
set(BUILD_GMOCK OFF)
set(INSTALL_GTEST OFF)
add_subdirectory(/usr/src/googletest googletest EXCLUDE_FROM_ALL SYSTEM)
# Of the tests, those that hold instruction sets or pictures to each other bit by bit; but not those that read files.
list(FILTER test_sources EXCLUDE REGEX "/(fxaa|smaa)(_[a-z]+)*_test\\.cpp$|/smaa/tables_test\\.cpp$")
foreach(test IN LISTS test_sources)
  file(STRINGS ${test} bits REGEX "supported_isas|0x[0-9a-f]+u\\);")
  if(bits)
    list(APPEND bit_tests ${test})
  endif()
endforeach()
add_executable(zoneplate_tests ${bit_tests})
target_link_libraries(zoneplate_tests PRIVATE zoneplate gtest_main)
target_precompile_headers(zoneplate_tests PRIVATE ${common_headers} <gtest/gtest.h>)
add_paths_for_tests("" "")
gtest_discover_tests(zoneplate_tests DISCOVERY_MODE PRE_TEST TEST_FILTER "*Bits:*NoTrace:*Twins*:*InstructionSet*")
