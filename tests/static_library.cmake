# SPDX-License-Identifier: Apache-2.0
# Configures the program with static libraries and reads what the installed library consists of, without building it.
#
# Given: build (a folder of its own), source, compiler, ninja.
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${source} -B ${build} -DZONEPLATE_STATIC=ON -DBUILD_TESTING=OFF
                        -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_MAKE_PROGRAM=${ninja} -DCMAKE_BUILD_TYPE=Release
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${ninja} -C ${build} -t query libzoneplate.a OUTPUT_VARIABLE parts COMMAND_ERROR_IS_FATAL ANY)
if(NOT parts MATCHES "cmake/fmt.cpp.o")
  message(FATAL_ERROR "libzoneplate.a lacks cmake/fmt.cpp.o: programs outside this tree would not link")
endif()
