# SPDX-License-Identifier: Apache-2.0
# The names of the shared libraries that the program opens when a file needs them, as the libraries beside the headers
# state them: another version may have other structures.
set(linked_suffixes ${CMAKE_FIND_LIBRARY_SUFFIXES})
set(CMAKE_FIND_LIBRARY_SUFFIXES .so)
set(sonames "")
foreach(library assimp avif jxl lcms2 meshoptimizer OpenEXRCore tiff zstd)
  string(TOLOWER ${library} name)
  find_library(shared_${name} ${library} REQUIRED)
  execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${shared_${name}} OUTPUT_VARIABLE sections COMMAND_ERROR_IS_FATAL ANY)
  if(NOT sections MATCHES "SONAME +([^ \n]+)")
    message(FATAL_ERROR "${shared_${name}} states no SONAME")
  endif()
  string(APPEND sonames "inline constexpr const char* soname_${name} = \"${CMAKE_MATCH_1}\";\n")
endforeach()
set(CMAKE_FIND_LIBRARY_SUFFIXES ${linked_suffixes})
configure_file(cmake/sonames.h.in ${generated}/zoneplate/sonames.h)
