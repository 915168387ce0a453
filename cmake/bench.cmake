# SPDX-License-Identifier: Apache-2.0
# Every bench/foo_bench.cpp is one program of Google Benchmark: build/bench/foo_bench.
find_package(benchmark REQUIRED)
file(GLOB benches CONFIGURE_DEPENDS bench/*_bench.cpp)
foreach(bench IN LISTS benches)
  get_filename_component(name ${bench} NAME_WE)
  add_executable(${name} ${bench})
  target_link_libraries(${name} PRIVATE zoneplate zoneplate_flags benchmark::benchmark)
endforeach()
find_library(embree_library embree3) # measured too where it is installed
if(embree_library)
  target_compile_definitions(ray_bench PRIVATE ZONEPLATE_EMBREE)
  target_link_libraries(ray_bench PRIVATE ${embree_library})
endif()

# The comparison with Mesa's software OpenGL, which bench/peers/run starts; its library is looked for when it runs.
find_path(opengl_headers GL/glcorearb.h)
if(opengl_headers)
  add_executable(peers bench/peers/compare.cpp bench/peers/mesa.cpp)
  target_link_libraries(peers PRIVATE zoneplate zoneplate_flags fmt::fmt ${CMAKE_DL_LIBS})
endif()

# What bench/peers/run-filters starts, beside a browser.
add_executable(peer_filters bench/peers/filters.cpp)
target_link_libraries(peer_filters PRIVATE zoneplate zoneplate_flags fmt::fmt)
