# SPDX-License-Identifier: Apache-2.0
# The sources and how they are built, on every processor.

# Every object may become part of a shared library, which exports what the public headers declare and nothing
# else (each header sets the default visibility for its declarations); calls within the library stay direct.
if(NOT EMSCRIPTEN)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

# One scene, one image, on every compiler: no contraction of a * b + c, no fast-math (docs/architecture.md).
add_library(zoneplate_flags INTERFACE)
target_compile_options(zoneplate_flags INTERFACE -ffp-contract=off $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition> -Wall -Wextra -Wconversion
                       $<IF:$<BOOL:${CMAKE_UNITY_BUILD}>,$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>,-Wshadow> # not names of other sources of a folder
                       -Wno-missing-field-initializers # designated initialisers leave out what keeps its default
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       # GCC's garbage collection, which takes a twentieth of the time of a build, begins at 1 GB
                       $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-undefined-var-template>) # tables of PerIsa (base/isa.h) have sources of their own
set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
target_include_directories(zoneplate_flags INTERFACE ${CMAKE_CURRENT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR}/src
                           ${generated})
configure_file(cmake/version.h.in ${generated}/zoneplate/version.h)

# Sources are found by their place and name: foo.cpp, foo_simd.cpp (once per instruction set), foo_test.cpp.
file(GLOB_RECURSE all_kernels RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS src/zoneplate/*_simd.cpp)
file(GLOB_RECURSE all_tests RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS src/zoneplate/*_test.cpp)
set(simd_sources ${all_kernels})
set(test_sources ${all_tests})
file(GLOB whole_tests RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS tests/*_test.cpp)

# The other sources of these folders of src/zoneplate and of the folders in them.
function(sources_of sources)
  list(TRANSFORM ARGN PREPEND src/zoneplate/ OUTPUT_VARIABLE patterns)
  list(TRANSFORM patterns APPEND /*.cpp)
  file(GLOB_RECURSE found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS ${patterns})
  list(REMOVE_ITEM found ${all_kernels} ${all_tests})
  set(${sources} ${found} PARENT_SCOPE)
endfunction()
sources_of(all_sources .)
# The rooms of the program, which are libraries of their own (CMakeLists.txt).
sources_of(program_sources process batch imaging evaluate lessons cli)
set(library_sources ${all_sources})
list(REMOVE_ITEM library_sources ${program_sources})

set_source_files_properties(src/zoneplate/raster/parts/packed_samples.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -O3) # vectors of 8 samples
set_source_files_properties(src/zoneplate/scene/geometry/smooth_normals.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -fno-math-errno) # roots in vectors, of the same bits

# A catalogue is a list of names, one a line, in <folder>/<list>.txt. The table is made from it: a function <table>() of
# <namespace>, which <header> declares, with a row for each name, that <prefix><name>() makes. Appends the source to
# <sources>.
function(make_table sources folder list header type namespace table prefix)
  set(listed src/zoneplate/${folder}/${list}.txt)
  file(STRINGS ${listed} names REGEX "^[a-z]")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${listed})
  set(declarations "")
  set(entries "")
  foreach(name IN LISTS names)
    string(APPEND declarations "${type} ${prefix}${name}();\n")
    string(APPEND entries "      ${prefix}${name}(),\n")
  endforeach()
  configure_file(cmake/table.cpp.in generated/${table}_table.cpp)
  set(${sources} ${${sources}} ${generated}/${table}_table.cpp PARENT_SCOPE)
endfunction()
make_table(library_sources scene/builtin makers scene/builtin/make.h BuiltinMaker zoneplate builtin_makers builtin_)
make_table(library_sources antialias methods antialias/methods.h Method zoneplate::antialias methods "")
make_table(library_sources upscale upscalers upscale/upscaler.h Upscaler zoneplate::upscale upscalers "")
include(cmake/trained_weights.cmake)

# Adds to the tests the source that defines the paths of base/paths_for_test.h.
function(add_paths_for_tests program_file appetite_program)
  configure_file(cmake/paths_for_test.cpp.in ${generated}/paths_for_test.cpp.in @ONLY)
  file(GENERATE OUTPUT ${generated}/paths_for_test.cpp INPUT ${generated}/paths_for_test.cpp.in)
  target_sources(zoneplate_tests PRIVATE ${generated}/paths_for_test.cpp)
endfunction()

# Builds the kernels once for each instruction set of the processor's architecture (base/isa.h), into ${kernel_objects}.
set(flags_sse4 -msse4.2)
set(flags_avx2 -mavx2 -mbmi -mbmi2 -mfma -mf16c -mlzcnt)
set(flags_neon -march=armv8-a+crypto) # what Highway asks for around each function, so that lambdas are like them
set(flags_avx512 ${flags_avx2} -mavx512f -mavx512bw -mavx512dq -mavx512vl)
if(EMSCRIPTEN)
  set(isas wasm)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  set(isas neon)
else()
  set(isas sse4 avx2 avx512)
endif()
function(add_kernels sources)
  set(objects "")
  foreach(isa IN LISTS isas)
    add_library(zoneplate_${isa} OBJECT ${sources})
    set_target_properties(zoneplate_${isa} PROPERTIES UNITY_BUILD OFF) # each names its kernels alike
    target_compile_options(zoneplate_${isa} PRIVATE ${flags_${isa}} $<$<NOT:$<BOOL:${ZONEPLATE_SANITIZED}>>:-O3>) # sanitized, -O3 takes minutes a source
    target_compile_definitions(zoneplate_${isa} PRIVATE HWY_COMPILE_ONLY_STATIC HWY_DISABLE_PCLMUL_AES
                               $<$<BOOL:${ZONEPLATE_SANITIZED}>:HWY_IS_DEBUG_BUILD=0>) # its assertions need its library
    target_link_libraries(zoneplate_${isa} PRIVATE zoneplate_flags)
    # Reading Highway's header is more than half of a kernel's compilation. GCC takes what is precompiled for the project's
    # own, and then warns of the compiler's vector headers.
    target_precompile_headers(zoneplate_${isa} PRIVATE <hwy/highway.h>)
    target_compile_options(zoneplate_${isa} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized$<SEMICOLON>-Wno-maybe-uninitialized>)
    list(APPEND objects $<TARGET_OBJECTS:zoneplate_${isa}>)
  endforeach()
  set(kernel_objects ${objects} PARENT_SCOPE)
endfunction()

# Checks that stop what a damaged file may still do: of the stack where a function has arrays, of sizes that the C
# library sees, and of tables of addresses, which are read-only from the start. Kernels get no bytes of files and go
# without.
function(harden target)
  if(EMSCRIPTEN OR ZONEPLATE_SANITIZED)
    return()
  endif()
  target_compile_options(${target} PRIVATE -fstack-protector-strong $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE>
                         $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
  target_link_options(${target} PRIVATE LINKER:-z,relro,-z,now)
endfunction()

# What nearly every source includes is parsed once; it halves the time of a build from nothing.
set(common_headers <algorithm> <array> <cmath> <cstdint> <functional> <map> <memory> <optional> <span> <string> <vector>
                   <fmt/format.h>)

# Where CMAKE_UNITY_BUILD is on, up to sixteen sources of a folder are compiled as one, and so many tests of a room, which
# halves the time of a build from nothing. Most codecs are compiled alone: each of them defines the same names.
function(compile_folders_together target)
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    if(source MATCHES "/codec/[^/]+$|/codec/(animated|bitmap|ktx2)/")
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    else()
      if(source MATCHES "_test\\.cpp$")
        string(REGEX MATCH "^src/zoneplate/[^/]+|^.*" folder "${folder}")
      endif()
      string(MAKE_C_IDENTIFIER "${folder}" group)
      list(APPEND files_${group} ${source})
      list(LENGTH files_${group} count)
      math(EXPR part "(${count} - 1) / 16")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${part})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  if(CMAKE_UNITY_BUILD)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>) # meant for headers
  endif()
endfunction()
