# Writes SOURCE, which defines stroke::NAME of HEADER: the SHA-256 over names and contents of FOLDERS below ROOT.
set(all "")
foreach(folder ${FOLDERS})
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.cpp)
  list(SORT files)
  foreach(file ${files})
    file(SHA256 ${ROOT}/${file} hash)
    string(APPEND all "${file} ${hash}\n")
  endforeach()
endforeach()
string(SHA256 hash "${all}")
file(CONFIGURE OUTPUT ${SOURCE} CONTENT [[
#include "@HEADER@"

const char* const tuft::stroke::@NAME@ = "@hash@";
]] @ONLY)
