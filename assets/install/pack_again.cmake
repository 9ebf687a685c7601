# SPDX-License-Identifier: Apache-2.0
# cpack reads this after it has packed: dpkg-deb packs the same files again, since in cpack's
# archives stands the umask of who packs.
set(space ${CPACK_TOPLEVEL_DIRECTORY}/again)
foreach(package IN LISTS CPACK_PACKAGE_FILES)
  file(REMOVE_RECURSE ${space})
  execute_process(COMMAND dpkg-deb --raw-extract ${package} ${space}
    COMMAND_ERROR_IS_FATAL ANY)
  file(CHMOD ${space} ${space}/DEBIAN DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  execute_process(COMMAND dpkg-deb -Zxz --root-owner-group --build ${space} ${package}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(REMOVE_RECURSE ${space})
