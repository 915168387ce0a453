# Installs the package, takes the library program out of README.md, builds it and the programs of examples/ against the
# package, and runs them.
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
# Configures and builds a project against the installed package.
function(build_project folder binary)
  run(${CMAKE_COMMAND} -G Ninja -S ${folder} -B ${binary} -DCMAKE_PREFIX_PATH=${place}/installed
      -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_CXX_FLAGS=${flags} -DCMAKE_BUILD_TYPE=Release)
  run(${CMAKE_COMMAND} --build ${binary})
endfunction()
# Fails if a picture is missing or empty.
function(expect_picture name)
  file(SIZE ${place}/${name} bytes)
  if(bytes LESS 1000)
    message(FATAL_ERROR "${name} has only ${bytes} bytes")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${build} --prefix ${place}/installed)
build_project(${source}/tests/consumer ${place}/build)
run(${place}/build/triangle)
expect_picture(triangle.png)

build_project(${source}/examples ${place}/examples)
run(${place}/examples/load_and_save ${source}/examples/triangle.gltf model.png)
expect_picture(model.png)
run(${place}/examples/arrays_to_pixels)
run(${place}/examples/textured_shader)
expect_picture(floor.png)
run(${place}/examples/own_method)
expect_picture(own_method.png)
