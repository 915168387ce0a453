# Installs the package, takes the library program out of README.md, builds it against the package and runs it.
#
# Given: build (the project's build folder), source, compiler, flags.
set(place ${build}/consumer)
file(REMOVE_RECURSE ${place})
file(MAKE_DIRECTORY ${place}/build)

file(READ ${source}/README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" found "${readme}")
if(NOT found)
  message(FATAL_ERROR "README.md has no ```cpp block")
endif()
file(WRITE ${place}/build/triangle.cpp "${CMAKE_MATCH_1}")

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${place} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${build} --prefix ${place}/installed)
run(${CMAKE_COMMAND} -G Ninja -S ${source}/tests/consumer -B ${place}/build -DCMAKE_PREFIX_PATH=${place}/installed
    -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_CXX_FLAGS=${flags} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${place}/build)
run(${place}/build/triangle)

# The program writes one picture, and a picture is not empty.
file(SIZE ${place}/triangle.png bytes)
if(bytes LESS 1000)
  message(FATAL_ERROR "triangle.png has only ${bytes} bytes")
endif()
