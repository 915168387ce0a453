# Every bench/foo_bench.cpp is one program of Google Benchmark: build/bench/foo_bench.
find_package(benchmark REQUIRED)
file(GLOB benches CONFIGURE_DEPENDS bench/*_bench.cpp)
foreach(bench IN LISTS benches)
  get_filename_component(name ${bench} NAME_WE)
  add_executable(${name} ${bench})
  target_link_libraries(${name} PRIVATE zoneplate zoneplate_flags benchmark::benchmark)
endforeach()
