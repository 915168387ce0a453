# SPDX-License-Identifier: Apache-2.0
# The renderer for the package for Node and browsers (node/), as an ES module and its WebAssembly: the core, the readers of
# models and images, metrics, and the interface for C. Not part of `all`: it fetches sources of libraries.
include(cmake/library_sources.cmake)

# Headers alone, for the formats of libraries that the package does not contain: reading one of them is an error.
file(GLOB tiff_headers /usr/include/*/tiff*.h)
foreach(header /usr/include/avif /usr/include/jxl /usr/include/lcms2.h ${tiff_headers})
  get_filename_component(name ${header} NAME)
  file(CREATE_LINK ${header} ${CMAKE_CURRENT_BINARY_DIR}/headers/${name} SYMBOLIC)
endforeach()
set_source_files_properties(src/zoneplate/codec/exr/exr.cpp src/zoneplate/codec/exr/exr_reader.cpp PROPERTIES
                            INCLUDE_DIRECTORIES /usr/include/OpenEXR SKIP_UNITY_BUILD_INCLUSION ON)

# The package defines it itself.
set_source_files_properties(src/zoneplate/shade/environment/prepare_studio.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

sources_of(package_sources capi codec formats job metrics)
sources_of(left_out formats/assimp formats/font)
list(REMOVE_ITEM package_sources ${left_out} ${streams} src/zoneplate/formats/gltf/draco.cpp src/zoneplate/codec/system/in_child.cpp)
list(APPEND package_sources src/zoneplate/os/cache_folder.cpp src/zoneplate/os/memory_limit.cpp
            src/zoneplate/report/json.cpp src/zoneplate/report/scene_contents.cpp)
make_table(package_sources metrics metrics metrics/metrics.h Metric zoneplate::metrics metrics "")
add_executable(zoneplate_node EXCLUDE_FROM_ALL node/native/module.cpp node/native/libraries.cpp
               node/native/flip_kernels.cpp web/file_bytes.cpp web/no_system.cpp ${package_sources})
set_target_properties(zoneplate_node PROPERTIES OUTPUT_NAME zoneplate)
compile_folders_together(zoneplate_node)
target_link_libraries(zoneplate_node PRIVATE zoneplate zoneplate_codecs zoneplate_playground_flags)
target_precompile_headers(zoneplate_node PRIVATE ${common_headers})
# Not -Os, with which clang 14 reads a value after its increment (make_codes in codec/png/deflate.cpp).
target_compile_options(zoneplate_node PRIVATE -O2)
# Functions that sources declare differently are a warning of the linker, and traps.
target_link_options(zoneplate_node PRIVATE -O2 -Wl,--fatal-warnings --no-entry -sMODULARIZE -sEXPORT_ES6 -sENVIRONMENT=worker -sEXIT_RUNTIME=0
                    -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=FS)
