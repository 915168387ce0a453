# SPDX-License-Identifier: Apache-2.0
# The weights of networks and tables, which the library contains.
foreach(name IN ITEMS learned learned_filters learned_smaa learned_still learned_table learned_table_still)
  set(weights ${CMAKE_CURRENT_SOURCE_DIR}/src/zoneplate/network/weights/${name}.bin)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${weights})
  file(READ ${weights} weights_${name} HEX)
  string(REGEX REPLACE "(..)" "0x\\1," weights_${name} "${weights_${name}}")
endforeach()
configure_file(cmake/trained_weights.cpp.in ${generated}/trained_weights.cpp @ONLY)
# Compiled alone: the page defines the function itself.
set_source_files_properties(${generated}/trained_weights.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
list(APPEND library_sources ${generated}/trained_weights.cpp)
