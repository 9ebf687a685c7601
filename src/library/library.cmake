# SPDX-License-Identifier: Apache-2.0
# libparhelion-panel: the measured panel for other renderers (src/library). Its sources are
# compiled once more, as a library that may lie anywhere in memory wants them, with nothing but
# the calls of parhelion_panel.h to be seen from outside; nothing is linked but the C library.
# One build for every CPU: the instructions of x86-64 itself. The same sources for AVX2 give the
# same bits and spectra in 0.86 of the time, but all else in 0.97 or more: no table of kernels.
include(GNUInstallDirs)
set(PANEL_LIBRARY_ABI 2)
set(panel_library_sources src/library/parhelion_panel.c src/library/open_panel.c
  src/library/emission_draw.c
  src/base/arena.c src/base/error.c src/base/file.c src/base/machine.c src/base/mathd.c
  src/base/sort.c src/print/print.c src/print/printable.c src/print/utf8.c
  src/spectrum/spectral_table.c src/spectrum/wavelengths.c
  src/hemisphere/geodesic.c src/hemisphere/specular_frame.c
  src/hemisphere/tree/vertex.c src/hemisphere/tree/vertex_code.c
  src/hemisphere/tree/vertex_open.c
  src/hemisphere/tree/vertex_query.c
  src/hemisphere/tree/tree_open.c src/hemisphere/tree/tree_query.c
  src/hemisphere/tree/tree_stop.c src/hemisphere/tree/tree_sum.c
  src/hemisphere/tree/sampling_tree.c src/hemisphere/tree/sampling_tree_build.c
  src/panel/shape/least_squares.c src/panel/shape/panel_levels.c
  src/panel/shape/panel_spline.c
  src/panel/shape/spectral_warp.c src/panel/shape/spot_ground.c)
foreach(file components emission info open open_emission open_reflection
    place reflection sampling section zones)
  list(APPEND panel_library_sources src/panel/query/panel_${file}.c)
endforeach()
list(APPEND panel_library_sources src/panel/zones/dimming_zones.c)

add_library(parhelion_panel SHARED ${panel_library_sources})
set_target_properties(parhelion_panel PROPERTIES OUTPUT_NAME parhelion-panel
  VERSION ${PANEL_LIBRARY_ABI}.${PROJECT_VERSION} SOVERSION ${PANEL_LIBRARY_ABI}
  C_VISIBILITY_PRESET hidden)
target_compile_options(parhelion_panel PRIVATE -Wno-psabi -ffunction-sections)
set(panel_library_map ${CMAKE_SOURCE_DIR}/src/library/parhelion_panel.map)
target_link_options(parhelion_panel PRIVATE -Wl,--gc-sections
  -Wl,--version-script=${panel_library_map})
if(NOT PARHELION_SANITIZE)
  target_link_options(parhelion_panel PRIVATE -Wl,-z,defs)
endif()
set_property(TARGET parhelion_panel PROPERTY LINK_DEPENDS ${panel_library_map})
target_link_libraries(parhelion_panel PRIVATE m)

set(PANEL_LIBRARY_PYTHON lib/python3/dist-packages)
# The way up from the folder of the .pc file, so that an installed tree may be moved.
string(REGEX REPLACE "[^/]+" ".." panel_library_up "${CMAKE_INSTALL_LIBDIR}")
configure_file(src/library/parhelion-panel.pc.in parhelion-panel.pc @ONLY)
install(TARGETS parhelion_panel
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libparhelion-panel2
  NAMELINK_COMPONENT libparhelion-panel-dev)
install(FILES src/library/parhelion_panel.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT libparhelion-panel-dev)
install(FILES ${CMAKE_BINARY_DIR}/parhelion-panel.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT libparhelion-panel-dev)
install(FILES src/library/parhelion_panel.py DESTINATION ${PANEL_LIBRARY_PYTHON}
  COMPONENT libparhelion-panel-dev)
install(FILES src/library/viewing_cone.py
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libparhelion-panel-dev/examples
  COMPONENT libparhelion-panel-dev)
