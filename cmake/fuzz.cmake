# SPDX-License-Identifier: Apache-2.0
# The fuzz targets of libFuzzer, fuzz_<format>, and the program that writes their seeds. They need clang.
#
# They take in the readers alone, and no child process, which would hide from the sanitizers (fuzz/child_seam.cpp).
set(fuzzed_rooms base os math image signal sdf codec scene formats network upscale/table)
sources_of(fuzzed_sources ${fuzzed_rooms})
list(REMOVE_ITEM fuzzed_sources src/zoneplate/formats/gltf/draco.cpp src/zoneplate/os/limited_child.cpp
                           src/zoneplate/upscale/table/learned_table.cpp)
list(APPEND fuzzed_sources ${generated}/builtin_makers_table.cpp)
list(TRANSFORM fuzzed_rooms REPLACE "(.+)" "src/zoneplate/\\1/*_simd.cpp" OUTPUT_VARIABLE fuzzed_kernels)
file(GLOB_RECURSE fuzzed_simd_sources RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS ${fuzzed_kernels})

add_library(zoneplate_fuzzed STATIC ${fuzzed_sources} fuzz/draco_seam.cpp fuzz/child_seam.cpp)
foreach(isa IN LISTS isas)
  add_library(zoneplate_fuzzed_${isa} OBJECT ${fuzzed_simd_sources})
  target_compile_options(zoneplate_fuzzed_${isa} PRIVATE ${flags_${isa}})
  target_compile_definitions(zoneplate_fuzzed_${isa} PRIVATE HWY_COMPILE_ONLY_STATIC HWY_DISABLE_PCLMUL_AES)
  target_link_libraries(zoneplate_fuzzed_${isa} PRIVATE zoneplate_flags)
  target_precompile_headers(zoneplate_fuzzed_${isa} PRIVATE <hwy/highway.h>)
  target_sources(zoneplate_fuzzed PRIVATE $<TARGET_OBJECTS:zoneplate_fuzzed_${isa}>)
endforeach()
target_link_libraries(zoneplate_fuzzed PUBLIC zoneplate_flags fmt::fmt Threads::Threads JPEG::JPEG ${webpmux_library} ${webpdemux_library}
                      ${webp_library} PNG::PNG ${CMAKE_DL_LIBS} ${seccomp_library} ${minizip_library} ${expat_library} z)
target_precompile_headers(zoneplate_fuzzed PRIVATE ${common_headers})
# What it stands in for has members that nothing uses here.
set_source_files_properties(fuzz/child_seam.cpp PROPERTIES COMPILE_OPTIONS -Wno-unused-private-field)

# Beside file formats: `scene`, what a child process answers, `manifest`, the lines of a batch,
# and `sdf`, scenes of shapes.
set(fuzz_formats gltf obj mtl ply stl 3mf amf png jpeg webp hdr exr pfm ktx2 bmp tga gif apng tiff avif jxl scene manifest sdf)
foreach(format IN LISTS fuzz_formats)
  set(kind model)
  if(format MATCHES "png|jpeg|webp|hdr|exr|pfm|ktx2|bmp|tga|gif|apng|tiff|avif|jxl")
    set(kind image)
  elseif(format MATCHES "scene|manifest|sdf")
    set(kind ${format})
  endif()
  add_executable(fuzz_${format} fuzz/${kind}_fuzz.cpp)
  target_compile_definitions(fuzz_${format} PRIVATE ZONEPLATE_FUZZ_FORMAT="${format}")
  target_link_libraries(fuzz_${format} PRIVATE zoneplate_fuzzed)
  target_link_options(fuzz_${format} PRIVATE -fsanitize=fuzzer)
endforeach()
add_executable(fuzz_item fuzz/item_fuzz.cpp src/zoneplate/process/item_messages.cpp src/zoneplate/process/packed_summary.cpp
               src/zoneplate/process/percents.cpp)
target_link_libraries(fuzz_item PRIVATE zoneplate_fuzzed)
target_link_options(fuzz_item PRIVATE -fsanitize=fuzzer)
add_executable(fuzz_weights fuzz/weights_fuzz.cpp)
target_link_libraries(fuzz_weights PRIVATE zoneplate_fuzzed)
target_link_options(fuzz_weights PRIVATE -fsanitize=fuzzer)
add_executable(fuzz_seeds fuzz/seeds.cpp)
find_library(tiff_library tiff REQUIRED)
target_link_libraries(fuzz_seeds PRIVATE zoneplate_fuzzed ${tiff_library})

# The default target builds the fuzz targets alone. The shared library would not even link: clang's sanitizers are part of
# a program, never of a library.
list(TRANSFORM isas PREPEND zoneplate_ OUTPUT_VARIABLE kernels)
set_target_properties(zoneplate zoneplate_objects zoneplate_readers zoneplate_shared ${kernels} zoneplate_process zoneplate_imaging
                      zoneplate_evaluate zoneplate_lessons zoneplate_cli zoneplate_program
                      PROPERTIES EXCLUDE_FROM_ALL ON)
