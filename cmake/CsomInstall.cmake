# SPDX-License-Identifier: BSD-3-Clause
# What an installed prefix holds, find_package(mrpt_csom), and the Debian package (cpack -G DEB).
include(CMakePackageConfigHelpers)

set(CSOM_INSTALL_DATADIR ${CMAKE_INSTALL_DATADIR}/mrpt_csom)
set(csom_doc_folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/mrpt-csom)
set(CSOM_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/mrpt_csom)

get_property(csom_libraries GLOBAL PROPERTY CSOM_LIBRARIES)
install(TARGETS ${csom_libraries} EXPORT mrpt_csomTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(library ${csom_libraries})
  get_target_property(source_folder ${library} SOURCE_DIR)
  install(DIRECTORY ${source_folder}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()

install(DIRECTORY config/ DESTINATION ${CSOM_INSTALL_DATADIR}
  FILES_MATCHING PATTERN "*.ini" PATTERN "*.yaml" PATTERN "*.onnx")
install(DIRECTORY docs/ DESTINATION ${csom_doc_folder})
install(FILES README.md CHANGELOG.md DESTINATION ${csom_doc_folder} OPTIONAL)
# The program holds the scripts of its reports, which are under a licence of their own.
install(FILES packaging/copyright DESTINATION ${csom_doc_folder})

string(REPLACE "csom-" "" CSOM_COMPONENTS "${csom_libraries}")
string(REPLACE ";" " " CSOM_COMPONENTS "${CSOM_COMPONENTS}")
install(EXPORT mrpt_csomTargets NAMESPACE csom:: DESTINATION ${CSOM_INSTALL_CMAKEDIR})
configure_package_config_file(
  cmake/mrpt_csomConfig.cmake.in ${PROJECT_BINARY_DIR}/mrpt_csomConfig.cmake
  INSTALL_DESTINATION ${CSOM_INSTALL_CMAKEDIR}
  PATH_VARS CSOM_INSTALL_DATADIR)
# Until 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mrpt_csomConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mrpt_csomConfig.cmake
  ${PROJECT_BINARY_DIR}/mrpt_csomConfigVersion.cmake
  DESTINATION ${CSOM_INSTALL_CMAKEDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mrpt-csom)
set(CPACK_PACKAGE_VENDOR "mrpt_csom project")
set(CPACK_PACKAGE_CONTACT "mrpt_csom maintainers <maintainers@mrpt-csom.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# mrpt-apps: the applications that load the plug-in. The -dev packages: what find_package() needs.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS mrpt-apps)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "libeigen3-dev, libtbb-dev, libyaml-cpp-dev, libsqlite3-dev, libzstd-dev, liblzf-dev, zlib1g-dev, nlohmann-json3-dev, liboctomap-dev, libdynamicedt3d-dev, libassimp-dev, libpng-dev, libzip-dev, libopencv-dev, libmrpt-maps-dev")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Builds maps whose voxels hold a probability for each semantic class, from
the rawlogs of the Mobile Robot Programming Toolkit or inside its own
applications, after the SEE-CSOM method. Contains the program csom, the
plug-in libcsom-maps.so and the C++ libraries.")
include(CPack)
