# Targets beside the programs: docs (Doxygen), format (clang-format on all that is listed), tidy (clang-tidy).
find_program(DOXYGEN doxygen)
set(docs_main_page ${CMAKE_SOURCE_DIR}/src/README.md)
if(NOT EXISTS ${docs_main_page})
  set(docs_main_page ${CMAKE_SOURCE_DIR}/README.md)
endif()
configure_file(.ci/Doxyfile.in ${CMAKE_BINARY_DIR}/Doxyfile @ONLY)
if(DOXYGEN)
  add_custom_target(docs COMMAND ${DOXYGEN} ${CMAKE_BINARY_DIR}/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E echo "open ${CMAKE_BINARY_DIR}/docs/html/index.html" VERBATIM)
endif()

find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
if(CLANG_FORMAT)
  add_custom_target(format COMMAND ${CMAKE_SOURCE_DIR}/.ci/format.sh ${CLANG_FORMAT} --write WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} VERBATIM)
endif()

# tidy looks at the modules and folders of TUFT_TIDY. Not among them yet: io/image, whose largest source takes it minutes.
find_program(CLANG_TIDY NAMES clang-tidy-14 clang-tidy)
set(TUFT_TIDY core mesh brush contact footprint app decal motion haptic pictures render variants writer atlas stroke cli ink/canvas ink/colour ink/composite ink/exchange ink/film ink/spectra ink/texels io/export io/font io/gltf io/import io/model io/motion io/package io/project io/scene io/sheet io/strokes io/svg CACHE STRING "Modules of src/ that the target tidy looks at")
if(CLANG_TIDY)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  add_custom_target(tidy COMMAND ${CMAKE_SOURCE_DIR}/.ci/tidy.sh ${CLANG_TIDY} ${CMAKE_BINARY_DIR} ${TUFT_TIDY}
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} VERBATIM)
endif()
