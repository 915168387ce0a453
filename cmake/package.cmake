# SPDX-License-Identifier: Apache-2.0
# Packages of the program (cpack: .deb and .tar.gz), without the library. The target `packages` writes them, the same
# bytes each time, into ${CMAKE_CURRENT_BINARY_DIR}/packages. Only the preset `release` links a program that needs no
# libraries but those of C.
install(FILES packaging/zoneplate.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT program)
install(FILES packaging/zoneplate.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
if(NOT ZONEPLATE_STATIC)
  return()
endif()

set(CPACK_GENERATOR DEB TGZ)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CONTACT "The Zoneplate authors <maintainers@zoneplate.invalid>")
set(CPACK_PACKAGE_VENDOR "The Zoneplate authors")
set(CPACK_PACKAGE_DESCRIPTION "Zoneplate renders 3D models to antialiased images on the CPU, without a GPU or display.
 It also makes thumbnails for file managers, compares images by metrics, and teaches antialiasing.")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_FILE_NAME zoneplate-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/cmake/package_archive.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6 (>= 2.36)")
# Opened when a file needs them: EXR, TIFF, AVIF, JPEG XL, Zstandard, meshopt and other formats; plots, captions and videos.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-dejavu-core, libopenexr-3-1-30, liblcms2-2, libtiff6, libavif15, libjxl0.7, libzstd1, libmeshoptimizer2d, libassimp5")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg, gnuplot-nox")
# Staged files get one time, that of SOURCE_DATE_EPOCH.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/cmake/package_times.cmake)
include(CPack)

add_custom_target(packages DEPENDS zoneplate_program
                  COMMAND ${CMAKE_COMMAND} -D source=${CMAKE_CURRENT_SOURCE_DIR}
                          -D config=${CMAKE_CURRENT_BINARY_DIR}/CPackConfig.cmake
                          -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/make_packages.cmake VERBATIM)
