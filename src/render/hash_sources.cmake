# SPDX-License-Identifier: Apache-2.0
# Writes the C file OUTPUT with a number that changes with everything that decides a pixel:
# cmake -DROOT=... -DOUTPUT=... -P hash_sources.cmake
set(folders base text spectrum hemisphere sky image panel scene bvh light mirror guide camera path film
  kernel render vision review/light)
set(patterns ${ROOT}/shaders/*.[ch] ${ROOT}/third_party/*/*.[ch]pp ${ROOT}/third_party/*/*.h)
foreach(folder ${folders})
  list(APPEND patterns ${ROOT}/src/${folder}/*.[ch])
endforeach()
file(GLOB_RECURSE files RELATIVE ${ROOT} ${patterns})
list(SORT files)
set(all "")
foreach(file ${files})
  file(SHA256 ${ROOT}/${file} hash)
  string(APPEND all "${hash} ${file}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 12 hash)
file(WRITE ${OUTPUT}
  "extern const char SOURCES_HASH[];\nconst char SOURCES_HASH[] = \"${hash}\";\n")
