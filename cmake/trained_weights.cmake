# SPDX-License-Identifier: Apache-2.0
# The weights of the network of `learned`, which the library contains.
set(trained_weights ${CMAKE_CURRENT_SOURCE_DIR}/src/zoneplate/upscale/learned/weights.bin)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${trained_weights})
file(READ ${trained_weights} trained_weights HEX)
string(REGEX REPLACE "(..)" "0x\\1," trained_weights "${trained_weights}")
configure_file(cmake/trained_weights.cpp.in ${generated}/trained_weights.cpp @ONLY)
list(APPEND library_sources ${generated}/trained_weights.cpp)
