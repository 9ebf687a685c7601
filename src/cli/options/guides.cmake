# Writes the pages of the folder INPUT as the table of src/cli/options/guides.h into OUTPUT:
# cmake -DINPUT=assets/guides -DOUTPUT=... -P guides.cmake
file(GLOB pages ${INPUT}/*.md)
set(arrays "")
set(rows "")
set(count 0)
foreach(page ${pages})
  get_filename_component(name ${page} NAME_WE)
  file(READ ${page} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "(................................................................................)"
    "\\1\n" bytes "${bytes}")
  string(APPEND arrays "static const char page_${count}[] = {\n${bytes}0};\n")
  string(APPEND rows "    {\"${name}\", page_${count}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"cli/options/guides.h\"\n\n${arrays}\n"
  "const Guide guide_table[] = {\n${rows}};\nconst int guide_count = ${count};\n")
