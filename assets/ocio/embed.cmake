# SPDX-License-Identifier: Apache-2.0
# Writes the text file INPUT as the C array NAME into OUTPUT:
# cmake -DINPUT=... -DOUTPUT=... -DNAME=... -P embed.cmake
# Letters are written as '\xNN', which suits a char of either sign.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
string(REGEX REPLACE
  "(....................................................................................)"
  "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "extern const char ${NAME}[];\nconst char ${NAME}[] = {\n${bytes}0};\n")
