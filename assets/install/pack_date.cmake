# SPDX-License-Identifier: Apache-2.0
# cpack reads this before it packs: every file in a package gets one time, so that the same
# sources give the same bytes. SOURCE_DATE_EPOCH if it is set; the last commit's; or, without
# git, that of the newest entry in `changelog`, beside this file.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  set(epoch "")
  if(EXISTS ${CPACK_PARHELION_ROOT}/.git)
    execute_process(COMMAND git -c safe.directory=${CPACK_PARHELION_ROOT}
        -C ${CPACK_PARHELION_ROOT} log -1 --format=%ct
      OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(NOT epoch MATCHES "^[0-9]+$")
    file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/changelog line REGEX "^ -- " LIMIT_COUNT 1)
    string(REGEX REPLACE "^.*>  " "" date "${line}")
    execute_process(COMMAND date -u -d "${date}" +%s
      OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${epoch})
endif()
