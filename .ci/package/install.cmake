# What `cmake --install` gives to other projects: headers, libraries and the CMake package `tuft`.
include(CMakePackageConfigHelpers)
set(tuft_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tuft)

add_library(tuft_all INTERFACE)
add_library(tuft::tuft ALIAS tuft_all)
set_target_properties(tuft_all PROPERTIES EXPORT_NAME tuft)
target_link_libraries(tuft_all INTERFACE tuft_io tuft_render)

install(TARGETS tuft_flags tuft_all EXPORT tuft)
install(EXPORT tuft NAMESPACE tuft:: FILE tuft-targets.cmake DESTINATION ${tuft_cmake_dir} COMPONENT dev)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/tuft-config.cmake.in ${CMAKE_BINARY_DIR}/package/tuft-config.cmake
  INSTALL_DESTINATION ${tuft_cmake_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/tuft-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/tuft-config.cmake ${CMAKE_BINARY_DIR}/package/tuft-config-version.cmake
  DESTINATION ${tuft_cmake_dir} COMPONENT dev)
# Headers that only the sources of a module include stay here: they bring other libraries along.
foreach(module ${tuft_libraries})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/src/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tuft COMPONENT dev
    FILES_MATCHING PATTERN "*.h"
    PATTERN "gl_*.h" EXCLUDE PATTERN "entry_json.h" EXCLUDE PATTERN "flat_area_json.h" EXCLUDE PATTERN "presets.h" EXCLUDE PATTERN "rod_newton.h" EXCLUDE PATTERN "rod_solver.h" EXCLUDE
    PATTERN "coupled_energy.h" EXCLUDE PATTERN "ldlt.h" EXCLUDE PATTERN "toml_text.h" EXCLUDE
    PATTERN "scene_document.h" EXCLUDE PATTERN "mtl_material.h" EXCLUDE PATTERN "gltf_prune.h" EXCLUDE PATTERN "gltf_file.h" EXCLUDE PATTERN "cad_faces.h" EXCLUDE
    PATTERN "xml_numbers.h" EXCLUDE PATTERN "json_number.h" EXCLUDE PATTERN "stroke_description.h" EXCLUDE PATTERN "task_arena.h" EXCLUDE)
endforeach()
