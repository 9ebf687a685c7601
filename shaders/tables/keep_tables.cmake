# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT by the program MAKER, unless this very program wrote it before:
# cmake -DMAKER=... -DOUTPUT=... -P keep_tables.cmake
file(SHA256 ${MAKER} sum)
set(known "")
if(EXISTS ${OUTPUT} AND EXISTS ${OUTPUT}.sum)
  file(READ ${OUTPUT}.sum known)
endif()
if(NOT known STREQUAL sum)
  execute_process(COMMAND ${MAKER} ${OUTPUT} COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${OUTPUT}.sum ${sum})
endif()
