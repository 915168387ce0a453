# SPDX-License-Identifier: Apache-2.0
# Installs the package, takes the library program out of README.md, builds it against the static library and the programs
# of examples/ against the shared one, and runs them. One program is built by pkg-config. Instead, with `headers`, each
# installed header is compiled alone, which takes as long as all that, and Clang compiles the programs.
#
# Given: build (the project's build folder), source, compiler, flags, headers (or nothing).
set(place ${build}/consumer${headers})
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
# Configures and builds a project against the installed package, with further options of CMake.
function(build_project folder binary)
  run(${CMAKE_COMMAND} -G Ninja -S ${folder} -B ${binary} -DCMAKE_PREFIX_PATH=${place}/installed
      -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_C_FLAGS=${flags} -DCMAKE_CXX_FLAGS=${flags} -DCMAKE_BUILD_TYPE=Release
      -DCMAKE_CXX_FLAGS_RELEASE=-O1 ${ARGN})
  run(${CMAKE_COMMAND} --build ${binary})
endfunction()
# The calls of docs/api.md are one program, which compiles as a user's own sources do, with warnings.
function(compile_calls compiler)
  file(STRINGS ${source}/docs/api.md rows REGEX "^\\| [^|]+ \\| `[a-z/_0-9]+\\.h` \\| `.*[;}]` \\|$")
  set(includes "#include <cstdio>\n")
  set(calls "")
  list(LENGTH rows count)
  foreach(row IN LISTS rows)
    string(REGEX MATCH "`([a-z/_0-9]+\\.h)` \\| `(.*)`" found "${row}")
    string(APPEND includes "#include \"zoneplate/${CMAKE_MATCH_1}\"\n")
    string(APPEND calls "  ${CMAKE_MATCH_2}\n")
  endforeach()
  if(count LESS 30)
    message(FATAL_ERROR "docs/api.md has ${count} calls")
  endif()
  file(WRITE ${place}/calls.cpp "${includes}using namespace zoneplate;\nint main() {\n${calls}}\n")
  run(${compiler} -std=c++20 -Wall -Wextra -Werror -Wno-unused-variable -Wno-unused-but-set-variable -fsyntax-only
      -I${place}/installed/include ${place}/calls.cpp)
endfunction()
# Fails if a picture is missing or empty.
function(expect_picture name)
  file(SIZE ${place}/${name} bytes)
  if(bytes LESS 1000)
    message(FATAL_ERROR "${name} has only ${bytes} bytes")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${build} --prefix ${place}/installed)
if(headers)
  file(GLOB_RECURSE installed RELATIVE ${place}/installed/include ${place}/installed/include/zoneplate/*.h)
  foreach(header IN LISTS installed)
    string(MAKE_C_IDENTIFIER ${header} name)
    file(WRITE ${place}/headers/${name}.cpp "#include \"${header}\"\n")
  endforeach()
  build_project(${source}/tests/consumer/headers ${place}/headers_build -DHEADERS=${place}/headers)
  find_program(clang NAMES clang++ clang++-14)
  if(clang)
    compile_calls(${clang})
    foreach(program load_and_save arrays_to_pixels textured_shader several_shaders course_shaders own_method)
      run(${clang} -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I${place}/installed/include
          ${source}/examples/${program}.cpp)
    endforeach()
  endif()
  return()
endif()
build_project(${source}/tests/consumer ${place}/build)
run(${place}/build/triangle)
expect_picture(triangle.png)

compile_calls(${compiler})

build_project(${source}/examples ${place}/examples -DBUILD_SHARED_LIBS=ON
              "-DCMAKE_CXX_FLAGS=${flags} -Wall -Wextra -Werror")
run(${place}/examples/load_and_save ${source}/examples/triangle.gltf model.png)
expect_picture(model.png)
run(${place}/examples/render_in_c ${source}/examples/triangle.gltf from_c.png)
expect_picture(from_c.png)
string(REPEAT "PPP~" 512 sky) # a Radiance image of 32 x 16 equal pixels
file(WRITE ${place}/sky.hdr "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n${sky}")
run(${place}/examples/product_shot ${source}/examples/triangle.gltf sky.hdr product.webp)
expect_picture(product.webp)
run(${place}/examples/arrays_to_pixels)
run(${place}/examples/textured_shader)
expect_picture(floor.png)
run(${place}/examples/several_shaders)
expect_picture(several_shaders.png)
run(${place}/examples/course_shaders ${source}/examples/triangle.gltf floor.png)
foreach(name normal phong texture bump displacement)
  expect_picture(${name}.png)
endforeach()
run(${place}/examples/own_method)
expect_picture(own_method.png)

# The shared library by pkg-config.
file(GLOB package_files ${place}/installed/lib*/pkgconfig/zoneplate.pc ${place}/installed/lib/*/pkgconfig/zoneplate.pc)
cmake_path(GET package_files PARENT_PATH package_folder)
set(ENV{PKG_CONFIG_PATH} ${package_folder})
execute_process(COMMAND pkg-config --cflags --libs zoneplate OUTPUT_VARIABLE options OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(options UNIX_COMMAND "${options} ${flags}")
execute_process(COMMAND pkg-config --variable=libdir zoneplate OUTPUT_VARIABLE libraries OUTPUT_STRIP_TRAILING_WHITESPACE)
run(${compiler} -O1 ${source}/examples/load_and_save.cpp ${options} -Wl,-rpath,${libraries} -o ${place}/by_pkg_config)
run(${place}/by_pkg_config ${source}/examples/triangle.gltf packaged.png)
file(SHA256 ${place}/model.png expected)
file(SHA256 ${place}/packaged.png found)
if(NOT expected STREQUAL found)
  message(FATAL_ERROR "the program that pkg-config built renders another picture")
endif()
