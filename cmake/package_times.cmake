# SPDX-License-Identifier: Apache-2.0
# Sets the times of all files that CPack has staged, so that packages do not depend on when they are built.
execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -exec touch -h -d @$ENV{SOURCE_DATE_EPOCH} {} +
                COMMAND_ERROR_IS_FATAL ANY)
