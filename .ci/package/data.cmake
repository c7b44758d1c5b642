# What is installed beside the programs: samples, manual pages and completions, what desktops read, and the papers
# that Debian wants in each package.
set(made ${CMAKE_BINARY_DIR}/package)
find_program(GZIP gzip REQUIRED)

# The programs write their manual pages and completions themselves, from the tables that they parse by.
function(tuft_manual program component)
  set(out ${made}/${program})
  add_custom_command(OUTPUT ${out}.stamp
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${out}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${out}
    COMMAND ${program} --reference ${out}
    COMMAND sh -c "exec \"$@\"" sh find ${out}/man1 -name "*.1" -exec ${GZIP} -9n {} +
    COMMAND ${CMAKE_COMMAND} -E touch ${out}.stamp
    DEPENDS ${program} VERBATIM)
  add_custom_target(${program}-manual ALL DEPENDS ${out}.stamp)
  install(DIRECTORY ${out}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT ${component})
  install(DIRECTORY ${out}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
  install(DIRECTORY ${out}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT ${component})
endfunction()
tuft_manual(tuft tuft)

install(DIRECTORY samples/strokes DESTINATION ${CMAKE_INSTALL_DATADIR}/tuft/samples COMPONENT tuft
  FILES_MATCHING PATTERN "*.inkml" PATTERN "*.svg" PATTERN "README.md")
install(DIRECTORY samples/inks DESTINATION ${CMAKE_INSTALL_DATADIR}/tuft/samples COMPONENT tuft FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY samples/variants DESTINATION ${CMAKE_INSTALL_DATADIR}/tuft/samples COMPONENT tuft FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY models/glyphs models/writer DESTINATION ${CMAKE_INSTALL_DATADIR}/tuft/models COMPONENT tuft)
install(DIRECTORY models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/tuft/models COMPONENT tuft FILES_MATCHING PATTERN "*.ply" PATTERN "*.md")
install(FILES samples/hello/main.cpp samples/hello/CMakeLists.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}-dev/examples/hello COMPONENT dev)

if(TUFT_STUDIO)
  tuft_manual(tuft-studio studio)
  set(desktop src/app/desktop)
  configure_file(${desktop}/tuft-studio.metainfo.xml.in ${made}/org.tuft.studio.metainfo.xml @ONLY)
  install(FILES ${made}/org.tuft.studio.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT studio)
  install(FILES ${desktop}/tuft-studio.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT studio)
  install(FILES ${desktop}/tuft-studio.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT studio)
  set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor)
  install(FILES ${desktop}/tuft-studio.svg DESTINATION ${icons}/scalable/apps COMPONENT studio)
  foreach(size 16 24 32 48 64 128 256)
    install(FILES ${desktop}/tuft-studio-${size}.png DESTINATION ${icons}/${size}x${size}/apps RENAME tuft-studio.png COMPONENT studio)
  endforeach()
endif()

execute_process(COMMAND date --utc --rfc-email --date=${TUFT_RELEASE_DATE} OUTPUT_VARIABLE release_time
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${made}/changelog.Debian @ONLY)
execute_process(COMMAND ${GZIP} -9nkf ${made}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(component ${CPACK_COMPONENTS_ALL})
  set(package tuft-${component})
  if(component STREQUAL tuft)
    set(package tuft)
  endif()
  install(FILES .ci/package/copyright ${made}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()
