# SPDX-License-Identifier: Apache-2.0
# find_package(Zoneplate) with the target Zoneplate::zoneplate, and zoneplate.pc, for programs outside this tree.
include(CMakePackageConfigHelpers)

set(installed_libraries zoneplate)
if(TARGET zoneplate_shared)
  list(APPEND installed_libraries zoneplate_shared)
endif()
install(TARGETS ${installed_libraries} EXPORT ZoneplateTargets)
install(TARGETS zoneplate_program COMPONENT program)
install(DIRECTORY include/zoneplate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${generated}/zoneplate/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/zoneplate)
set(CMAKE_INSTALL_DOCDIR ${CMAKE_INSTALL_DATADIR}/doc/zoneplate)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program) # Debian's name
install(FILES THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
if(NOT CMAKE_CROSSCOMPILING)
  # The manual page and the completions of shells are printed by the program when it is installed.
  set(printed ${CMAKE_CURRENT_BINARY_DIR}/printed)
  install(CODE "
    file(MAKE_DIRECTORY \"${printed}\")
    foreach(pair man:zoneplate.1 completions,bash:zoneplate completions,zsh:_zoneplate completions,fish:zoneplate.fish)
      string(REGEX MATCH \"^(.*):(.*)$\" ignored \"\${pair}\")
      set(output \"${printed}/\${CMAKE_MATCH_2}\")
      string(REPLACE \",\" \";\" arguments \"\${CMAKE_MATCH_1}\")
      execute_process(COMMAND \"$<TARGET_FILE:zoneplate_program>\" \${arguments} OUTPUT_FILE \"\${output}\" COMMAND_ERROR_IS_FATAL ANY)
    endforeach()" COMPONENT program)
  install(FILES ${printed}/zoneplate.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${printed}/zoneplate DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${printed}/_zoneplate DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
  install(FILES ${printed}/zoneplate.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Zoneplate)
install(EXPORT ZoneplateTargets NAMESPACE Zoneplate:: DESTINATION ${package_directory})
configure_package_config_file(cmake/ZoneplateConfig.cmake.in ZoneplateConfig.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(ZoneplateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ZoneplateConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ZoneplateConfigVersion.cmake
        DESTINATION ${package_directory})

configure_file(cmake/zoneplate.pc.in zoneplate.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/zoneplate.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
