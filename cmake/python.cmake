# SPDX-License-Identifier: Apache-2.0
# The Python module and its wheel, in ${CMAKE_CURRENT_BINARY_DIR}/python: built only by the target `wheel`, which
# ./check --python makes in build/release. The module uses CPython's limited API, so that one file serves all versions
# from 3.11 on; it contains the library, and needs the C library alone.
find_path(python_headers Python.h PATH_SUFFIXES python3.11 python3.12 python3.13)
find_program(python_program python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT python_headers OR NOT python_program)
  return()
endif()
file(GLOB python_sources CONFIGURE_DEPENDS python/native/*.cpp)
add_library(zoneplate_python MODULE EXCLUDE_FROM_ALL ${python_sources})
set_target_properties(zoneplate_python PROPERTIES UNITY_BUILD OFF) # each source names its tables alike
target_link_libraries(zoneplate_python PRIVATE zoneplate zoneplate_flags)
target_include_directories(zoneplate_python SYSTEM PRIVATE ${python_headers})
harden(zoneplate_python)
set(python_folder ${CMAKE_CURRENT_BINARY_DIR}/python)
set_target_properties(zoneplate_python PROPERTIES PREFIX "" OUTPUT_NAME _native SUFFIX .abi3.so
                      LIBRARY_OUTPUT_DIRECTORY ${python_folder}/module)
target_link_options(zoneplate_python PRIVATE -s LINKER:--exclude-libs,ALL LINKER:--gc-sections)

file(GLOB_RECURSE python_files CONFIGURE_DEPENDS python/zoneplate/*.py python/zoneplate/*.pyi)
add_custom_target(wheel DEPENDS zoneplate_python ${python_files}
                  COMMAND ${python_program} ${CMAKE_CURRENT_SOURCE_DIR}/python/make_wheel.py --version ${PROJECT_VERSION}
                          --module $<TARGET_FILE:zoneplate_python> --output ${python_folder}/wheel VERBATIM)
