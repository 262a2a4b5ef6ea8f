# Programs, manual pages, completions and what a desktop knows of them, installed; and Debian packages of all: `cpack`.

install(TARGETS relume COMPONENT relume)
install(TARGETS relume-viewer COMPONENT viewer)

set(completions ${PROJECT_SOURCE_DIR}/apps/relume/completions)
install(FILES ${completions}/relume DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT relume)
install(FILES ${completions}/_relume DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT relume)
install(FILES ${completions}/relume.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT relume)

set(desktop ${PROJECT_SOURCE_DIR}/apps/viewer/desktop)
install(FILES ${desktop}/relume-viewer.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT viewer)
install(FILES ${desktop}/relume.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT viewer)
install(FILES ${desktop}/relume.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT viewer)
install(FILES ${desktop}/relume.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT viewer)
install(PROGRAMS ${desktop}/relume-thumbnail DESTINATION ${CMAKE_INSTALL_LIBEXECDIR} COMPONENT viewer)

# Manual pages are what --help says.
find_program(HELP2MAN help2man)
if(HELP2MAN AND NOT CMAKE_CROSSCOMPILING)
  file(READ ${PROJECT_SOURCE_DIR}/apps/relume/main.cpp main)
  string(REGEX MATCHALL "add[A-Za-z]+Command\\(program\\)" commands "${main}")
  set(pages)
  foreach(page relume relume-viewer ${commands})
    set(program relume)
    set(command)
    if(page STREQUAL "relume-viewer")
      set(program relume-viewer)
    elseif(page MATCHES "^add([A-Za-z]+)Command")
      string(TOLOWER "${CMAKE_MATCH_1}" command)
      set(page relume-${command})
    endif()
    set(file ${PROJECT_BINARY_DIR}/man/${page}.1)
    add_custom_command(
      OUTPUT ${file}
      COMMAND ${HELP2MAN} --locale=C.UTF-8 --no-info --no-discard-stderr --version-string=${PROJECT_VERSION} --source=Relume
              --manual=Relume --name "relight glossy objects in real time" --output ${file}
              "$<TARGET_FILE:${program}> ${command}"
      DEPENDS ${program}
      COMMENT "Manual page ${page}.1"
      VERBATIM)
    list(APPEND pages ${file})
    set(component relume)
    if(program STREQUAL "relume-viewer")
      set(component viewer)
    endif()
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component} OPTIONAL)
  endforeach()
  add_custom_target(relume_manual DEPENDS ${pages})
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Relume authors <relume@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Relight glossy objects in real time, with all-frequency shadows")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL relume viewer dev)
if(TARGET relume_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RELUME_PACKAGE_NAME relume)
set(CPACK_DEBIAN_RELUME_PACKAGE_DEPENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME relume-viewer)
set(CPACK_DEBIAN_VIEWER_PACKAGE_DEPENDS "relume (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-relume)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-numpy, mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "relume, python3-matplotlib, python3-jinja2") # relume.laboratory
set(CPACK_DEBIAN_DEV_PACKAGE_NAME librelume-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "libvulkan-dev, libglm-dev, libfmt-dev, libzstd-dev, libxxhash-dev, libspirv-cross-c-shared-dev, libopenexr-dev, libpng-dev, zlib1g-dev, libtinygltf-dev, libtinyobjloader-dev, libmeshoptimizer-dev, libstb-dev, nlohmann-json3-dev")
include(CPack)
