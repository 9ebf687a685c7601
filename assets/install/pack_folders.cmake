# SPDX-License-Identifier: Apache-2.0
# cpack reads this before it packs: folders are open to all, whatever the umask of who packs.
# Links are left alone: one that points into another package has no end here.
file(GLOB_RECURSE found LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(path IN LISTS found ITEMS ${CPACK_TEMPORARY_DIRECTORY})
  if(IS_DIRECTORY ${path} AND NOT IS_SYMLINK ${path})
    file(CHMOD ${path} DIRECTORY_PERMISSIONS
      OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endif()
endforeach()
