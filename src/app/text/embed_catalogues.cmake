# cmake -DMSGFMT=program -DFOLDER=folder -DLANGUAGES=en,zh_CN -DOUT=file.cpp -P embed_catalogues.cmake: each LANGUAGE.po,
# checked and compiled by msgfmt, as bytes of a source.
string(REPLACE "," ";" LANGUAGES "${LANGUAGES}")
set(text "#include <span>\n\nnamespace tuft::app {\n")
foreach(language IN LISTS LANGUAGES)
  execute_process(COMMAND ${MSGFMT} --check --no-hash --endianness=little -o ${OUT}.${language}.mo ${FOLDER}/${language}.po
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUT}.${language}.mo bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND text "\nnamespace {\nconstexpr unsigned char k_${language}[] = {${bytes}};\n}\n"
    "std::span<const unsigned char> catalogue_${language}();\n"
    "std::span<const unsigned char> catalogue_${language}() {\n    return k_${language};\n}\n")
endforeach()
string(APPEND text "\n}  // namespace tuft::app\n")
file(WRITE ${OUT} "${text}")
