# SPDX-License-Identifier: Apache-2.0
# The renderer for the page of web/playground, as an ES module and its WebAssembly: the core, the readers of
# models, and the lessons.
find_path(nlohmann_headers nlohmann/json.hpp PATHS /usr/include REQUIRED NO_CMAKE_FIND_ROOT_PATH)
file(CREATE_LINK ${nlohmann_headers}/nlohmann ${CMAKE_CURRENT_BINARY_DIR}/headers/nlohmann SYMBOLIC)
# For the types of functions alone: the page has no library for Zstandard.
file(CREATE_LINK /usr/include/zstd.h ${CMAKE_CURRENT_BINARY_DIR}/headers/zstd.h SYMBOLIC)

# files.cpp takes the place of the sources that need libraries or child processes.
set(readers ${all_sources})
list(FILTER readers INCLUDE REGEX "^src/zoneplate/formats/(gltf|import|json|obj|ply|stl)/|codec/(hdr\\.cpp$|ktx2/|bitmap/tga)|report/json\\.cpp$")
list(FILTER readers EXCLUDE REGEX "_test\\.cpp$|/(draco|image_file|scene_bytes)\\.cpp$")

# The lessons of `zoneplate demo`. Functions of these sources that need more are not linked, since nothing calls them;
# figures.cpp and truetype.cpp take the place of those that draw texts and plots.
set(figures ${all_sources})
list(FILTER figures INCLUDE REGEX "^src/zoneplate/(cli/demo/|job/output/false_color|cli/sdf/(atlas_file|show_field|text_error)|formats/font/text_outline|report/(figure|page_table|plot_labels|plot_palette)\\.cpp|metrics/(mse|flip/magma))")
list(FILTER figures EXCLUDE REGEX "_test\\.cpp$|_simd\\.cpp$|/demo/demo\\.cpp$")
make_table(figures cli/demo demos cli/demo/demo.h Demo zoneplate::cli demos demo_)
# Compiled alone, since they define the same names as others of their folders.
set_source_files_properties(src/zoneplate/formats/gltf/mesh.cpp src/zoneplate/formats/obj/mtl_material.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
add_executable(zoneplate_playground web/playground/session.cpp web/playground/look.cpp web/playground/files.cpp
               web/file_bytes.cpp web/playground/figures.cpp web/playground/truetype.cpp
               ${readers} ${figures})
compile_folders_together(zoneplate_playground)
target_link_libraries(zoneplate_playground PRIVATE zoneplate)
# The page has one instruction set, whose vectors every kernel has (base/isa.h); a tenth of the module was scalar twins.
target_compile_definitions(zoneplate PUBLIC ZONEPLATE_WITHOUT_SCALAR_TWINS)
# What takes time is in the library; a page that is smaller is there sooner.
target_compile_options(zoneplate_playground PRIVATE -Oz)
# Sizes have 32 bits here; session.cpp limits the memory of a model to less. A library, so that its options come last.
add_library(zoneplate_playground_flags INTERFACE)
target_compile_options(zoneplate_playground_flags INTERFACE -include ${CMAKE_CURRENT_SOURCE_DIR}/cmake/wasm_readers.h
                       -Wno-shorten-64-to-32 -Wno-unused-private-field)
target_link_libraries(zoneplate_playground PRIVATE zoneplate_playground_flags)
target_precompile_headers(zoneplate_playground PRIVATE ${common_headers})
target_link_options(zoneplate_playground PRIVATE -O2 --no-entry -sMODULARIZE -sEXPORT_ES6 -sENVIRONMENT=worker -sEXIT_RUNTIME=0
                    -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=ccall,FS)
# With threads (cmake/wasm_threads.cmake), the workers of all of them are there before the first call: a browser starts
# none while a function runs. No more threads are started than there are workers.
if(CMAKE_CXX_FLAGS MATCHES "-pthread")
  target_link_options(zoneplate_playground PRIVATE -sEXPORTED_RUNTIME_METHODS=ccall,FS,wasmMemory -sPTHREAD_POOL_SIZE=Module.threads-1 -sPTHREAD_POOL_SIZE_STRICT=2)
endif()
