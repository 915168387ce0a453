# find_package(Zoneplate) and the target Zoneplate::zoneplate, for programs outside this tree.
include(CMakePackageConfigHelpers)

install(TARGETS zoneplate EXPORT ZoneplateTargets)
install(TARGETS zoneplate_program)
install(DIRECTORY src/zoneplate ${generated}/zoneplate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "cli" EXCLUDE PATTERN "commit.h" EXCLUDE PATTERN "sonames.h" EXCLUDE)

install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Zoneplate)
install(EXPORT ZoneplateTargets NAMESPACE Zoneplate:: DESTINATION ${package_directory})
configure_package_config_file(cmake/ZoneplateConfig.cmake.in ZoneplateConfig.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(ZoneplateConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ZoneplateConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ZoneplateConfigVersion.cmake
        DESTINATION ${package_directory})
