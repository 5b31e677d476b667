# Install rules and the Debian package (packages of the group `package` in packages.txt):
#   cmake --build build && cpack --config build/CPackConfig.cmake
include(GNUInstallDirs)

set(share ${CMAKE_INSTALL_DATADIR})
find_program(GZIP gzip)
# packed(FILE FOLDER): the file, as small as gzip makes it, into the folder.
function(packed file folder)
  if(NOT GZIP)
    return()
  endif()
  get_filename_component(name ${file} NAME)
  set(made ${CMAKE_BINARY_DIR}/${name}.gz)
  add_custom_command(OUTPUT ${made} COMMAND ${GZIP} -9nc ${file} > ${made} DEPENDS ${file} VERBATIM)
  add_custom_target(packed_${name} ALL DEPENDS ${made})
  install(FILES ${made} DESTINATION ${folder})
endfunction()
# Netgen's libraries lie in a folder of their own, which the installed programs must remember; lintian
# is told why.
if(NGLIB_LIBRARY)
  get_filename_component(NGLIB_FOLDER ${NGLIB_LIBRARY} DIRECTORY)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/lintian-overrides DESTINATION ${share}/lintian/overrides
          RENAME lamella)
endif()
if(TARGET lamella-cli)
  set_target_properties(lamella-cli PROPERTIES INSTALL_RPATH "${NGLIB_FOLDER}")
  install(TARGETS lamella-cli)
  set(completion ${CMAKE_BINARY_DIR}/lamella-cli.bash)
  add_custom_command(OUTPUT ${completion}
    COMMAND lamella-cli completion bash > ${completion} DEPENDS lamella-cli VERBATIM)
  add_custom_target(lamella_completion ALL DEPENDS ${completion})
  install(FILES ${completion} DESTINATION ${share}/bash-completion/completions RENAME lamella-cli)
  set(manual ${CMAKE_BINARY_DIR}/lamella-cli.1)
  add_custom_command(OUTPUT ${manual}
    COMMAND lamella-cli manual > ${manual} DEPENDS lamella-cli VERBATIM)
  packed(${manual} ${CMAKE_INSTALL_MANDIR}/man1)
endif()
if(TARGET lamella)
  set_target_properties(lamella PROPERTIES INSTALL_RPATH "${NGLIB_FOLDER}")
  install(TARGETS lamella)
  set(manual ${CMAKE_BINARY_DIR}/lamella.1)
  add_custom_command(OUTPUT ${manual}
    COMMAND lamella --manual > ${manual} DEPENDS lamella VERBATIM)
  packed(${manual} ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/org.lamella.Lamella.desktop DESTINATION ${share}/applications)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/org.lamella.Lamella.metainfo.xml DESTINATION ${share}/metainfo)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/org.lamella.Lamella.mime.xml DESTINATION ${share}/mime/packages
          RENAME org.lamella.Lamella.xml)
  install(FILES ${PROJECT_SOURCE_DIR}/resources/icons/lamella.svg
          DESTINATION ${share}/icons/hicolor/scalable/apps RENAME org.lamella.Lamella.svg)
endif()
packed(${CMAKE_CURRENT_LIST_DIR}/changelog ${share}/doc/lamella)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${share}/doc/lamella)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${share}/doc/lamella)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/resources/docs/ DESTINATION ${share}/doc/lamella/docs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lamella)
set(CPACK_PACKAGE_CONTACT "Lamella maintainers <maintainers@lamella.invalid>")
set(CPACK_PACKAGE_VENDOR Lamella)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "anisotropic tetrahedral meshes for injection molding")
set(CPACK_PACKAGE_DESCRIPTION
    "Lamella reads STEP and STL parts and makes tetrahedral meshes with n\n\
element layers through every wall. lamella is the window, lamella-cli the\n\
batch program.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(NGLIB_LIBRARY)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${NGLIB_FOLDER})
endif()
# What is linked is found by dpkg-shlibdeps; the window falls back to another font without this one.
# Qt's own buttons speak the language of the window with the translations.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-inter, qt6-translations-l10n")
include(CPack)
