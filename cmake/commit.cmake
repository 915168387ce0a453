# SPDX-License-Identifier: Apache-2.0
# Writes the header that holds the commit of the sources, if it is another one than there: run by every build, with
# `source`, the folder of the sources, and `header`, the file.
execute_process(COMMAND git -C ${source} describe --always --dirty --abbrev=12 --exclude=* OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(commit unknown)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/commit.h.in ${header})
