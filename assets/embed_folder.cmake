# SPDX-License-Identifier: Apache-2.0
# Writes the files of the folder INPUT as a table into OUTPUT: TABLE_table of {name, text}, with
# an empty row behind the last, and TABLE_count, as the header HEADER declares them. A name has no
# ending, unless files of several kinds lie there (NAMES=NAME). Letters are written as '\xNN',
# which suits a char of either sign.
# cmake -DINPUT=assets/guides/*.md -DHEADER=cli/options/guides.h -DTYPE=Guide -DTABLE=guide
#     -DOUTPUT=... -P embed_folder.cmake
file(GLOB files ${INPUT})
if(NOT NAMES)
  set(NAMES NAME_WE)
endif()
set(arrays "")
set(rows "")
set(count 0)
foreach(file ${files})
  get_filename_component(name ${file} ${NAMES})
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(REGEX REPLACE
    "(....................................................................................)"
    "\\1\n" bytes "${bytes}")
  string(APPEND arrays "static const char text_${count}[] = {\n${bytes}0};\n")
  string(APPEND rows "    {\"${name}\", text_${count}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"\n\n${arrays}\n"
  "const ${TYPE} ${TABLE}_table[] = {\n${rows}    {0}};\nconst int ${TABLE}_count = ${count};\n")
