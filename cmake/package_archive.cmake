# SPDX-License-Identifier: Apache-2.0
# Read by CPack for each kind of package: an archive has one folder, with bin and share in it, for any place.
if(CPACK_GENERATOR STREQUAL TGZ)
  set(CPACK_PACKAGING_INSTALL_PREFIX /)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
endif()
