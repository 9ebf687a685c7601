# SPDX-License-Identifier: Apache-2.0
# What is installed, where, and in which package. Every path below the prefix is relative to the
# program (src/base/program.h), so that an installed tree may be moved as a whole. The library of
# panels, where it is built, has rules of its own, which come first.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

install(TARGETS parhelion RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT parhelion)
install(TARGETS parhelion_pictures
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/parhelion COMPONENT parhelion)

# ---- pages, of what `parhelion help --json` says ----
find_package(Python3 COMPONENTS Interpreter REQUIRED)
set(pages ${CMAKE_BINARY_DIR}/installed)
add_custom_command(OUTPUT ${pages}/completions/parhelion
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/assets/install/pages.py
    $<TARGET_FILE:parhelion> ${pages}
  DEPENDS parhelion assets/install/pages.py assets/install/completion.bash
    assets/schemas/json_answers.md)
add_custom_target(pages ALL DEPENDS ${pages}/completions/parhelion)
# What `cmake --install` wants built, without the tests.
add_custom_target(product DEPENDS parhelion parhelion_pictures pages)
if(TARGET parhelion_panel)
  add_dependencies(product parhelion_panel)
endif()
install(DIRECTORY ${pages}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT parhelion)
install(FILES ${pages}/completions/parhelion COMPONENT parhelion
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)

# ---- scenes, and what the guides' commands and pages name ----
set(share ${CMAKE_INSTALL_DATADIR}/parhelion)
install(DIRECTORY assets/schemas assets/profiles assets/coatings assets/spectra assets/ci
    assets/slurm assets/denoise
  DESTINATION ${share}/assets COMPONENT parhelion PATTERN "*.py" EXCLUDE
  PATTERN json_answers.md EXCLUDE)
install(FILES ${pages}/json_answers.md DESTINATION ${share}/assets/schemas COMPONENT parhelion)
install(DIRECTORY assets/content assets/panels
  DESTINATION ${share}/assets COMPONENT parhelion-scenes)
install(DIRECTORY scenes DESTINATION ${share} COMPONENT parhelion-scenes
  PATTERN modelling EXCLUDE PATTERN "*.py" EXCLUDE PATTERN "*.sh" EXCLUDE)

# ---- packages: cpack --config CPackConfig.cmake ----
set(PARHELION_MAINTAINER "Parhelion maintainers <maintainers@parhelion.invalid>" CACHE STRING
  "who answers for the packages")
get_cmake_property(components COMPONENTS)
list(REMOVE_ITEM components Unspecified)
set(MAINTAINER ${PARHELION_MAINTAINER})
configure_file(assets/install/changelog ${CMAKE_BINARY_DIR}/changelog @ONLY)
set(changelog ${CMAKE_BINARY_DIR}/changelog.Debian.gz)
execute_process(COMMAND gzip -9nc ${CMAKE_BINARY_DIR}/changelog OUTPUT_FILE ${changelog}
  COMMAND_ERROR_IS_FATAL ANY)
foreach(component ${components})
  install(FILES assets/install/copyright ${changelog} COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${component})
endforeach()

# package(COMPONENT SECTION SUMMARY TEXT [NAME VALUE ...]): CPack's variables of a component
function(package component section summary text)
  string(TOUPPER ${component} upper)
  set(prefix CPACK_DEBIAN_${upper}_PACKAGE_)
  set(${prefix}NAME ${component} PARENT_SCOPE)
  set(${prefix}SECTION ${section} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  while(ARGN)
    list(POP_FRONT ARGN name value)
    set(${prefix}${name} "${value}" PARENT_SCOPE)
  endwhile()
endfunction()

# Lines of texts: at most 79 letters, as Debian has it.
package(parhelion graphics "physically correct frames of dashboards with displays"
  "Parhelion traces light through a glTF interior lit by the sun and the sky of
a place and time, or by lamps. The displays in it emit and reflect as measured
panels do. Every pixel of a frame is a luminance in cd/m2; reviews tell what
can be read, and when it glares."
  SHLIBDEPS ON DEPENDS fonts-dejavu-core RECOMMENDS parhelion-scenes)
package(parhelion-scenes graphics "scenes, panels and contents for Parhelion"
  "A car's dashboard, an airliner's flight deck, their displays, people in the
seats and lights: what the commands of Parhelion's guides render."
  ARCHITECTURE all RECOMMENDS parhelion)
package(libparhelion-panel2 libs "measured display panels for renderers"
  "What a measured display emits and reflects at every angle, asked in place
from a .panel file as Parhelion makes it. This package has the shared library."
  SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBPARHELION-PANEL2_PACKAGE_CONTROL_EXTRA
  ${CMAKE_BINARY_DIR}/shlibs ${CMAKE_SOURCE_DIR}/assets/install/triggers)
package(libparhelion-panel-dev libdevel
  "measured display panels for renderers, development"
  "What a measured display emits and reflects at every angle, asked in place
from a .panel file as Parhelion makes it. This package has the header, and a
module for Python."
  DEPENDS "libparhelion-panel2 (= ${PROJECT_VERSION}-1)" SUGGESTS "python3, python3-numpy")
# What depends on the library wants at least the version that it was built with.
file(WRITE ${CMAKE_BINARY_DIR}/shlibs
  "libparhelion-panel 2 libparhelion-panel2 (>= ${PROJECT_VERSION})\n")

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE parhelion)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${PARHELION_MAINTAINER})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PARHELION_ROOT ${CMAKE_SOURCE_DIR})
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/assets/install/pack_date.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/assets/install/pack_folders.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/assets/install/pack_again.cmake)
set(CMAKE_SKIP_PACKAGE_ALL_DEPENDENCY ON)
include(CPack)
