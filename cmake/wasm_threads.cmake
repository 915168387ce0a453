# SPDX-License-Identifier: Apache-2.0
# As wasm.cmake, with threads: memory is shared, and every thread is a worker of the browser.
include(${CMAKE_CURRENT_LIST_DIR}/wasm.cmake)
string(APPEND CMAKE_CXX_FLAGS_INIT " -pthread")
string(APPEND CMAKE_EXE_LINKER_FLAGS_INIT " -pthread -Wno-pthreads-mem-growth")
