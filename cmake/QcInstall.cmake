# Installation: headers, the shared library, a package for find_package and one for pkg-config (the
# program and the plugins install themselves). The static twin is for tests only and stays behind.
# The components are the packages of QcPackages.cmake; `licence` belongs to none, as each has its own.
include(CMakePackageConfigHelpers)

# Headers alone: what a plugin needs which calls no function of the library.
add_library(quadcover_headers INTERFACE)
add_library(QuadCover::headers ALIAS quadcover_headers)
set_target_properties(quadcover_headers PROPERTIES EXPORT_NAME headers)
target_include_directories(quadcover_headers INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/sdk/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/sdk/include/qc DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development FILES_MATCHING PATTERN "*.h")
install(TARGETS quadcover_shared quadcover_headers EXPORT QuadCoverTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/plugins/template
        ${PROJECT_SOURCE_DIR}/docs/examples
        DESTINATION ${CMAKE_INSTALL_DATADIR}/quadcover COMPONENT development PATTERN "build*" EXCLUDE)

set(_qc_package ${CMAKE_INSTALL_LIBDIR}/cmake/QuadCover)
install(EXPORT QuadCoverTargets NAMESPACE QuadCover:: DESTINATION ${_qc_package}
        COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/QuadCoverConfig.cmake.in
  ${PROJECT_BINARY_DIR}/QuadCoverConfig.cmake INSTALL_DESTINATION ${_qc_package})
# Before 1.0 a new minor version may change the API.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/QuadCoverConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/QuadCoverConfig.cmake
        ${PROJECT_BINARY_DIR}/QuadCoverConfigVersion.cmake
        DESTINATION ${_qc_package} COMPONENT development)

file(RELATIVE_PATH QC_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/qc.pc.in ${PROJECT_BINARY_DIR}/qc.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/qc.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)
