# SPDX-License-Identifier: Apache-2.0
# Every foo_test.cpp and tests/*_test.cpp in one program, and the tests that are not C++.
find_package(GTest REQUIRED)

# Of what takes time in the tests themselves.
set(laborious_options $<$<NOT:$<CONFIG:Debug>>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)

# Writes the inputs of tests/appetite_test.cpp; a program of its own, to be run by hand too.
file(GLOB appetite_sources CONFIGURE_DEPENDS fuzz/appetite*.cpp)
add_executable(fuzz_appetite ${appetite_sources})
target_link_libraries(fuzz_appetite PRIVATE zoneplate_flags ${fmt} z)
target_compile_options(fuzz_appetite PRIVATE ${laborious_options})
compile_folders_together(fuzz_appetite)

add_executable(zoneplate_tests ${test_sources} ${whole_tests})
find_library(meshoptimizer_library meshoptimizer REQUIRED) # packs what tests unpack
find_library(tiff_library tiff REQUIRED) # likewise
target_link_libraries(zoneplate_tests PRIVATE ${meshoptimizer_library} ${tiff_library} zoneplate_cli GTest::gtest_main)
# A fifth less to build than with -O1; what takes time is in the libraries, or in the tests named here.
target_compile_options(zoneplate_tests PRIVATE -O0)
set(laborious shade/environment/prepared_environment shade/surface/shading shade/reflection/brdf shade/surface/layered raster/coverage/coverage
    raster/tile/rasterize
    raster/geometry/small_triangles signal/fourier/fourier formats/gltf/damage antialias/post/smaa/smaa sdf/shape)
list(TRANSFORM laborious REPLACE "(.+)" "src/zoneplate/\\1_test.cpp")
list(APPEND laborious tests/motion_test.cpp tests/environment_error_test.cpp tests/layers_test.cpp tests/words_test.cpp)
set_source_files_properties(${laborious} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "${laborious_options}")
add_paths_for_tests("$<TARGET_FILE:zoneplate_program>" "$<TARGET_FILE:fuzz_appetite>")
add_dependencies(zoneplate_tests zoneplate_program fuzz_appetite)
compile_folders_together(zoneplate_tests)
target_precompile_headers(zoneplate_tests PRIVATE ${common_headers} <gtest/gtest.h>)
set(program "$<TARGET_FILE:zoneplate_tests>")
set(directory ${CMAKE_CURRENT_BINARY_DIR})
set(together 12)
configure_file(cmake/suites.cmake.in ${generated}/suites.cmake.in @ONLY)
file(GENERATE OUTPUT ${generated}/suites.cmake INPUT ${generated}/suites.cmake.in)
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${generated}/suites.cmake)

# Embree judges rays where it is installed.
find_library(embree_library embree3)
find_path(embree_headers embree3/rtcore.h)
if(embree_library AND embree_headers)
  set_source_files_properties(src/zoneplate/ray/embree_test.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON
                              COMPILE_OPTIONS "${laborious_options}" COMPILE_DEFINITIONS ZONEPLATE_EMBREE)
  target_link_libraries(zoneplate_tests PRIVATE ${embree_library})
  add_test(NAME ten_million_rays CONFIGURATIONS Long
           COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=Embree.DISABLED_AgreesAboutTenMillionRays)
  set_tests_properties(ten_million_rays PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")
endif()

# What takes minutes, only for `ctest -C Long`.
foreach(pattern RANGE 5)
  add_test(NAME million_triangles_${pattern} CONFIGURATIONS Long
           COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=Coverage/Million.*/${pattern})
  set_tests_properties(million_triangles_${pattern} PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")
endforeach()

# A hundred runs of a batch that are ended at some moment, and resumed.
add_test(NAME killed_batch CONFIGURATIONS Long
         COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=KilledBatch.DISABLED_IsResumedAHundredTimes)
set_tests_properties(killed_batch PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")

# Ten million triangles read in parts, and in memory.
add_test(NAME out_of_core CONFIGURATIONS Long
         COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=OutOfCoreProgram.DISABLED_*)
set_tests_properties(out_of_core PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")

# The most bytes that a prepared environment can have.
add_test(NAME largest_environment CONFIGURATIONS Long
         COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=PreparedEnvironment.DISABLED_*)
set_tests_properties(largest_environment PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")

# The tables of docs/environment.md.
add_test(NAME environment_error CONFIGURATIONS Long
         COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=EnvironmentError.*)
set_tests_properties(environment_error PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")

# The images of README.md and docs/, made again, and the marked figures of their tables, measured again.
foreach(kind Images Figures)
  string(TOLOWER document_${kind} name)
  add_test(NAME ${name} CONFIGURATIONS Long
           COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=Document${kind}.*)
  set_tests_properties(${name} PROPERTIES TIMEOUT 3600 FAIL_REGULAR_EXPRESSION "Running 0 tests")
endforeach()

# Every input of fuzz_appetite takes minutes: only for `ctest -C Long`.
foreach(test EveryInputStaysWithinTheLimits EveryInputStaysWithinTheLimitsOfEveryVerb JobsBesideAllOfThemAreDone)
  add_test(NAME Appetite.${test} CONFIGURATIONS Long
           COMMAND zoneplate_tests --gtest_also_run_disabled_tests --gtest_filter=Appetite.DISABLED_${test})
  set_tests_properties(Appetite.${test} PROPERTIES TIMEOUT 3600 RUN_SERIAL TRUE FAIL_REGULAR_EXPRESSION "Running 0 tests")
endforeach()

# The 20-line program of README.md, built against an installed package as a user would.
set(consumer ${CMAKE_COMMAND} -D build=${CMAKE_CURRENT_BINARY_DIR} -D source=${CMAKE_CURRENT_SOURCE_DIR}
             -D compiler=${CMAKE_CXX_COMPILER} -D flags=${CMAKE_CXX_FLAGS})
set(consumer_script -P ${CMAKE_CURRENT_SOURCE_DIR}/tests/consumer/run.cmake)
add_test(NAME consumer COMMAND ${consumer} ${consumer_script})
set_tests_properties(consumer PROPERTIES COST 1000) # the longest begins first
add_test(NAME installed_headers CONFIGURATIONS Long COMMAND ${consumer} -D headers=_headers ${consumer_script})

if(TARGET zoneplate_shared AND NOT ZONEPLATE_SANITIZED)
  add_test(NAME shared_library COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/shared_library.sh $<TARGET_FILE:zoneplate_shared>)
endif()

# Which commit messages ./check refuses.
add_test(NAME commit_messages
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/commit_messages_test.sh ${CMAKE_CURRENT_SOURCE_DIR})

# The installed library of the release preset contains what it uses of {fmt}.
add_test(NAME static_library COMMAND ${CMAKE_COMMAND} -D build=${CMAKE_CURRENT_BINARY_DIR}/static_library
         -D source=${CMAKE_CURRENT_SOURCE_DIR} -D compiler=${CMAKE_CXX_COMPILER} -D ninja=${CMAKE_MAKE_PROGRAM}
         -P ${CMAKE_CURRENT_SOURCE_DIR}/tests/static_library.cmake)

# When the wrapper scripts build again.
add_test(NAME setup COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/setup_test.sh ${CMAKE_CURRENT_SOURCE_DIR})

if(NOT ZONEPLATE_SANITIZED)
  add_test(NAME hardening COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/hardening.sh $<TARGET_FILE:zoneplate_program>)
endif()

# Kernels for newer processors must not reach programs on older ones through shared inline functions.
if(NOT ZONEPLATE_SANITIZED AND simd_sources)
  list(TRANSFORM isas REPLACE "(.+)" "$<TARGET_OBJECTS:zoneplate_\\1>" OUTPUT_VARIABLE objects)
  add_test(NAME simd_symbols COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/simd_symbols.sh ${objects} COMMAND_EXPAND_LISTS)
endif()
