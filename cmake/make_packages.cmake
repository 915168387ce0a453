# SPDX-License-Identifier: Apache-2.0
# Runs CPack with the time of the last commit as the time of every file. Given: source, config.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git -C ${source} log -1 --format=%ct OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
  if(NOT epoch)
    set(epoch 1) # an exported tree
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${epoch})
endif()
execute_process(COMMAND cpack --config ${config} COMMAND_ERROR_IS_FATAL ANY)
