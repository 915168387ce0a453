# SPDX-License-Identifier: Apache-2.0
# The viewer of web/report as one page, which the library contains. Its modules become one script: lines that import are
# left out, and so is the word export.
set(viewer ${CMAKE_CURRENT_SOURCE_DIR}/web/report)
set(viewer_script "")
foreach(module bytes png light picture dom view inspector pane pointer sequence stage table plot main)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer}/${module}.js)
  file(READ ${viewer}/${module}.js text)
  string(REGEX REPLACE "\nimport [^\n]*" "" text "${text}")
  string(REGEX REPLACE "\nexport " "\n" text "${text}")
  string(APPEND viewer_script "${text}\n")
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer}/page.html ${viewer}/style.css)
file(READ ${viewer}/style.css viewer_style)
file(READ ${viewer}/page.html viewer_page)
string(REPLACE "{{style}}" "${viewer_style}" viewer_page "${viewer_page}")
string(REPLACE "{{script}}" "${viewer_script}" viewer_page "${viewer_page}")
configure_file(cmake/viewer_page.cpp.in ${generated}/viewer_page.cpp @ONLY)
list(APPEND library_sources ${generated}/viewer_page.cpp)
