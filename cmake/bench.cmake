# SPDX-License-Identifier: Apache-2.0
# Every bench/foo_bench.cpp is one program of Google Benchmark: build/bench/foo_bench.
find_package(benchmark REQUIRED)
file(GLOB benches CONFIGURE_DEPENDS bench/*_bench.cpp)
foreach(bench IN LISTS benches)
  get_filename_component(name ${bench} NAME_WE)
  add_executable(${name} ${bench})
  target_link_libraries(${name} PRIVATE zoneplate zoneplate_flags benchmark::benchmark)
endforeach()
target_link_libraries(network_bench PRIVATE zoneplate_evaluate) # the machine's limits
find_library(embree_library embree3) # measured too where it is installed
if(embree_library)
  target_compile_definitions(ray_bench PRIVATE ZONEPLATE_EMBREE)
  target_link_libraries(ray_bench PRIVATE ${embree_library})
endif()

# The comparison with Mesa's software OpenGL and Vulkan, which bench/peers/run starts; their libraries are looked for when
# it runs.
find_path(opengl_headers GL/glcorearb.h)
find_path(vulkan_headers vulkan/vulkan_raii.hpp)
find_program(glslang glslangValidator)
if(opengl_headers AND vulkan_headers AND glslang)
  set(spirv ${CMAKE_CURRENT_BINARY_DIR}/peers_spirv)
  file(MAKE_DIRECTORY ${spirv})
  set(variants plain lit textured lit_textured)
  set(defines "-DPLAIN" "-DLIT" "-DTEXTURED" "-DLIT -DTEXTURED")
  set(includes)
  foreach(stage vert frag)
    foreach(variant define IN ZIP_LISTS variants defines)
      set(name ${stage}_${variant})
      separate_arguments(define)
      add_custom_command(OUTPUT ${spirv}/${name}.h DEPENDS bench/peers/mesh.${stage}
                         COMMAND ${glslang} --quiet -V ${define} --vn ${name} -o ${spirv}/${name}.h
                                 ${CMAKE_CURRENT_SOURCE_DIR}/bench/peers/mesh.${stage})
      list(APPEND spirv_headers ${spirv}/${name}.h)
      string(APPEND includes "#include \"${name}.h\"\n")
    endforeach()
  endforeach()
  file(CONFIGURE OUTPUT ${spirv}/mesh_spirv.h CONTENT "#include <cstdint>\n${includes}")
  add_executable(peers bench/peers/compare.cpp bench/peers/lavapipe.cpp bench/peers/llvmpipe.cpp bench/peers/uploads.cpp
                 ${spirv_headers})
  set_target_properties(peers PROPERTIES UNITY_BUILD OFF)
  target_include_directories(peers SYSTEM PRIVATE ${spirv} ${vulkan_headers})
  target_link_libraries(peers PRIVATE zoneplate zoneplate_flags fmt::fmt ${CMAKE_DL_LIBS})
endif()

# What bench/peers/run-filters starts, beside a browser.
add_executable(peer_filters bench/peers/filters.cpp)
target_link_libraries(peer_filters PRIVATE zoneplate zoneplate_flags fmt::fmt)
