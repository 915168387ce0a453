# SPDX-License-Identifier: Apache-2.0
# The renderer for the page of web/playground, as an ES module and its WebAssembly: the core, the readers of
# models, and the lessons.
find_path(nlohmann_headers nlohmann/json.hpp PATHS /usr/include REQUIRED NO_CMAKE_FIND_ROOT_PATH)
file(CREATE_LINK ${nlohmann_headers}/nlohmann ${CMAKE_CURRENT_BINARY_DIR}/headers/nlohmann SYMBOLIC)
# For the types of functions alone: the page has no library for Zstandard and Deflate. The package for Node has a zlib,
# whose own headers define another type of offsets.
foreach(header headers/zstd.h playground_headers/zlib.h playground_headers/zconf.h)
  get_filename_component(name ${header} NAME)
  get_filename_component(folder ${CMAKE_CURRENT_BINARY_DIR}/${header} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK /usr/include/${name} ${folder}/${name} SYMBOLIC)
endforeach()

# A module has no memory beside that of its files, so that reading these in parts saves none.
set(streams formats/open_stream formats/gltf/stream/stream formats/obj/part_cache formats/obj/stream formats/ply/stream formats/stl/stream job/render_streamed)
list(TRANSFORM streams REPLACE "(.+)" "src/zoneplate/\\1.cpp")
# The readers of models, and the job. files.cpp and ../no_system.cpp take the place of the sources that need libraries or
# child processes.
sources_of(readers formats/gltf formats/import formats/json formats/obj formats/ply formats/stl codec/ktx2 job)
list(REMOVE_ITEM readers src/zoneplate/formats/gltf/draco.cpp src/zoneplate/formats/import/image_file.cpp
                         src/zoneplate/formats/import/scene_bytes.cpp src/zoneplate/job/import_time.cpp ${streams})
list(APPEND readers src/zoneplate/codec/hdr.cpp src/zoneplate/codec/save.cpp src/zoneplate/codec/bitmap/tga.cpp
            src/zoneplate/formats/load.cpp src/zoneplate/os/cache_folder.cpp src/zoneplate/os/memory_limit.cpp
            src/zoneplate/report/json.cpp)

# The lessons of `zoneplate demo`, and what they use of other rooms; figures.cpp and truetype.cpp take the place of what
# draws texts and plots.
sources_of(lessons lessons)
make_table(lessons lessons demos lessons/demo.h Demo zoneplate::lessons demos demo_)
set(figures imaging/sdf/atlas_file imaging/sdf/show_field imaging/sdf/text_error formats/font/text_outline
    report/figure report/page_table report/plot_labels report/plot_palette metrics/mse metrics/power metrics/psnr
    metrics/flip/magma)
list(TRANSFORM figures REPLACE "(.+)" "src/zoneplate/\\1.cpp")
# Compiled alone, since they define the same names as others of their folders.
set_source_files_properties(src/zoneplate/formats/gltf/mesh.cpp src/zoneplate/formats/obj/mtl_material.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# Sizes have 32 bits here; session.cpp limits the memory of a model to less. A library, so that its options come last.
add_library(zoneplate_playground_flags INTERFACE)
target_compile_options(zoneplate_playground_flags INTERFACE -include ${CMAKE_CURRENT_SOURCE_DIR}/cmake/wasm_readers.h
                       -Wno-shorten-64-to-32 -Wno-unused-private-field)
add_library(zoneplate_readers STATIC ${readers})
add_library(zoneplate_lessons STATIC ${lessons} ${figures})
add_executable(zoneplate_playground web/playground/session.cpp web/playground/files.cpp web/file_bytes.cpp
               web/no_system.cpp web/playground/figures.cpp web/playground/truetype.cpp web/playground/weights.cpp)
target_link_libraries(zoneplate_playground PRIVATE zoneplate_lessons zoneplate_readers)
# What takes time is in the library; a page that is smaller is there sooner.
foreach(target zoneplate_readers zoneplate_lessons zoneplate_playground)
  compile_folders_together(${target})
  target_compile_options(${target} PRIVATE -Oz)
  target_include_directories(${target} SYSTEM PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/playground_headers)
  target_link_libraries(${target} PRIVATE zoneplate zoneplate_playground_flags)
  target_precompile_headers(${target} PRIVATE ${common_headers})
endforeach()
# The page has one instruction set, whose vectors every kernel has (base/isa.h); a tenth of the module was scalar twins.
target_compile_definitions(zoneplate PUBLIC ZONEPLATE_WITHOUT_SCALAR_TWINS)
target_link_options(zoneplate_playground PRIVATE -Oz -Wl,--fatal-warnings --no-entry -sMODULARIZE -sEXPORT_ES6 -sENVIRONMENT=worker -sEXIT_RUNTIME=0
                    -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=ccall,FS)
# With threads (cmake/wasm_threads.cmake), the workers of all of them are there before the first call: a browser starts
# none while a function runs. No more threads are started than there are workers.
if(CMAKE_CXX_FLAGS MATCHES "-pthread")
  target_link_options(zoneplate_playground PRIVATE -sEXPORTED_RUNTIME_METHODS=ccall,FS,wasmMemory -sPTHREAD_POOL_SIZE=Module.threads-1 -sPTHREAD_POOL_SIZE_STRICT=2)
endif()
