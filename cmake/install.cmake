# SPDX-License-Identifier: Apache-2.0
# cmake --install: the program with its scenes and documents, the Python package, the libraries for find_package(Earthshine).
# CPack makes of them the Debian packages earthshine, python3-earthshine and earthshine-dev (./dev package).
include(GNUInstallDirs)
set(share ${CMAKE_INSTALL_DATADIR}/earthshine)
set(doc ${CMAKE_INSTALL_DATADIR}/doc/earthshine)
install(TARGETS earthshine RUNTIME COMPONENT earthshine)
install(DIRECTORY scenes/library/ DESTINATION ${share}/scenes COMPONENT earthshine PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY studies/library/ DESTINATION ${share}/studies COMPONENT earthshine)
install(DIRECTORY docs/ DESTINATION ${doc} COMPONENT earthshine FILES_MATCHING PATTERN "*.md" PATTERN "log" EXCLUDE
  PATTERN "decisions" EXCLUDE PATTERN "images" EXCLUDE)
install(FILES README.md CHANGELOG.md DESTINATION ${doc} COMPONENT earthshine)
install(FILES LICENSE DESTINATION ${doc} RENAME copyright COMPONENT earthshine)

# The man page and the shells' completions, by the program itself.
set(pages ${CMAKE_BINARY_DIR}/pages)
file(MAKE_DIRECTORY ${pages})
add_custom_command(OUTPUT ${pages}/earthshine.1 ${pages}/earthshine ${pages}/_earthshine ${pages}/earthshine.fish
  COMMAND earthshine manual > ${pages}/earthshine.1
  COMMAND earthshine completion bash > ${pages}/earthshine
  COMMAND earthshine completion zsh > ${pages}/_earthshine
  COMMAND earthshine completion fish > ${pages}/earthshine.fish
  DEPENDS earthshine VERBATIM)
add_custom_target(earthshine_pages ALL DEPENDS ${pages}/earthshine.1)
install(FILES ${pages}/earthshine.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT earthshine)
install(FILES ${pages}/earthshine DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT earthshine)
install(FILES ${pages}/_earthshine DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT earthshine)
install(FILES ${pages}/earthshine.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT earthshine)

# The libraries: static, with the headers of each floor.
get_property(libraries GLOBAL PROPERTY EARTHSHINE_LIBRARIES)
set_target_properties(earthshine_alone PROPERTIES EXPORT_NAME alone)
install(TARGETS ${libraries} earthshine_alone earthshine_flags EXPORT EarthshineTargets ARCHIVE COMPONENT earthshine-dev)
foreach(floor base scenes radiosity raytrace degrade studies)
  install(DIRECTORY ${floor} DESTINATION include/earthshine COMPONENT earthshine-dev FILES_MATCHING PATTERN "*.h"
    PATTERN "library" EXCLUDE)
endforeach()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Earthshine)
install(EXPORT EarthshineTargets NAMESPACE earthshine:: DESTINATION ${config} COMPONENT earthshine-dev)
install(FILES cmake/EarthshineConfig.cmake cmake/hdf5.cmake DESTINATION ${config} COMPONENT earthshine-dev)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME earthshine)
set(CPACK_PACKAGE_VENDOR "Earthshine")
set(CPACK_PACKAGE_CONTACT "The authors of Earthshine <earthshine@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Light in a spacecraft's payload bay, and what its CCTV cameras show of it")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_SOURCE_DIR}/out)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL earthshine earthshine-dev)
if(EARTHSHINE_HAS_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python3-earthshine)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_EARTHSHINE_PACKAGE_NAME earthshine)
set(CPACK_DEBIAN_EARTHSHINE_PACKAGE_SUGGESTS "gnuplot-nox, python3-earthshine")
set(CPACK_DEBIAN_EARTHSHINE-DEV_PACKAGE_NAME earthshine-dev)
set(CPACK_DEBIAN_EARTHSHINE-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_EARTHSHINE-DEV_PACKAGE_DEPENDS "libembree-dev, libeigen3-dev, libopenexr-dev, libglm-dev, libtbb-dev, libtomlplusplus-dev, libtinygltf-dev, nlohmann-json3-dev, libpng-dev, libjpeg-dev, libhdf5-dev, libfmt-dev")
set(CPACK_DEBIAN_PYTHON3-EARTHSHINE_PACKAGE_NAME python3-earthshine)
set(CPACK_DEBIAN_PYTHON3-EARTHSHINE_PACKAGE_DEPENDS "${EARTHSHINE_PYTHON_VERSIONS}, python3-numpy")
set(CPACK_DEBIAN_PYTHON3-EARTHSHINE_PACKAGE_SUGGESTS "python3-pandas, earthshine")
set(CPACK_DEBIAN_PYTHON3-EARTHSHINE_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/prerm")
include(CPack)
