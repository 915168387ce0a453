# SPDX-License-Identifier: Apache-2.0
# Builds for WebAssembly with Debian's Emscripten; what is built runs in Node.
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
find_program(node NAMES node nodejs REQUIRED NO_CMAKE_FIND_ROOT_PATH)
# What Emscripten 3.1.6 writes would fetch itself from the net where Node can.
set(CMAKE_CROSSCOMPILING_EMULATOR ${node} --no-experimental-fetch)
# Node's own modules of Debian, wherever Node is from.
set(CMAKE_CXX_LINKER_LAUNCHER ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs)
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fwasm-exceptions -include ${CMAKE_CURRENT_LIST_DIR}/wasm_library.h")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fwasm-exceptions -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=4GB -sEXIT_RUNTIME")
