# Debian packages, one for each component of the installation: `cpack` in the build folder, or `make
# packages`. docs/packages.md says what is in which.
find_program(QC_GZIP gzip)
find_program(QC_SHLIBDEPS dpkg-shlibdeps)
if(NOT QC_GZIP OR NOT QC_SHLIBDEPS OR QC_SANITIZE)
  return()
endif()
set(QC_PACKAGE_MAINTAINER "The QuadCover SDK authors <quadcover@packages.invalid>" CACHE STRING
    "Name and address in the Debian packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME quadcover)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each has its own
set(CPACK_PACKAGE_CONTACT "${QC_PACKAGE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
    GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # what the distribution has; our own library by component
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)

# Every package has the licence and a list of changes.
file(STRINGS ${PROJECT_SOURCE_DIR}/LICENSE _holder REGEX "^Copyright ")
string(REGEX REPLACE "^Copyright \\(c\\) " "" _holder "${_holder}")
file(READ ${PROJECT_SOURCE_DIR}/LICENSE _terms)
string(REGEX REPLACE "^.*(Permission is hereby)" "\\1" _terms "${_terms}")
string(STRIP "${_terms}" _terms)
string(REPLACE "\n\n" "\n.\n" _terms "${_terms}")
string(REPLACE "\n" "\n " _terms " ${_terms}")
string(TIMESTAMP _date "%a, %d %b %Y %H:%M:%S +0000" UTC) # or that of SOURCE_DATE_EPOCH
set(_folder ${PROJECT_BINARY_DIR}/debian)
foreach(_file copyright changelog)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/${_file}.in ${_folder}/${_file} @ONLY)
endforeach()
execute_process(COMMAND ${QC_GZIP} -9nc ${_folder}/changelog COMMAND_ERROR_IS_FATAL ANY
                OUTPUT_FILE ${_folder}/changelog.gz)

# qc_package(component package section summary text [DEPENDS components] [PACKAGES Debian packages]
# [SUGGESTS packages] [SCRIPTS control files])
macro(qc_package component package section summary text)
  cmake_parse_arguments(_p "" "PACKAGES;SUGGESTS" "DEPENDS;SCRIPTS" ${ARGN})
  string(TOUPPER ${component} _name)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_COMPONENT_${_name}_DEPENDS ${_p_DEPENDS})
  set(CPACK_DEBIAN_${_name}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${_name}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${_name}_DESCRIPTION "${summary}\n${text}")
  set(CPACK_DEBIAN_${_name}_PACKAGE_DEPENDS "${_p_PACKAGES}")
  set(CPACK_DEBIAN_${_name}_PACKAGE_SUGGESTS "${_p_SUGGESTS}")
  set(CPACK_DEBIAN_${_name}_PACKAGE_CONTROL_EXTRA ${_p_SCRIPTS})
  install(FILES ${_folder}/copyright ${_folder}/changelog.gz EXCLUDE_FROM_ALL
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endmacro()

set(_text "QuadCover turns triangle meshes into meshes of quads: a cross field on the
surface is made integrable on a branched covering, and the integer isolines
of the map which results are the edges of the quads.\n\n")
set(_major ${PROJECT_VERSION_MAJOR})
# What is built against the library depends on its very version: docs/abi.md, no promise before 1.0.
file(WRITE ${_folder}/shlibs "libquadcover ${_major} libquadcover${_major} (= ${PROJECT_VERSION})\n")
qc_package(library libquadcover${_major} libs
  "quad meshing by field-guided parameterization - library"
  "${_text}This package has the shared library."
  SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/triggers ${_folder}/shlibs)
qc_package(program quadcover graphics
  "quad meshing by field-guided parameterization - program"
  "${_text}This package has the program quadcover." DEPENDS library)
qc_package(development libquadcover-dev libdevel
  "quad meshing by field-guided parameterization - development files"
  "${_text}This package has the headers, the files for CMake and pkg-config, the template
of a plugin and examples." DEPENDS library)
if(TARGET python_wheel)
  qc_package(python python3-quadcover python
    "quad meshing by field-guided parameterization - Python 3"
    "${_text}This package has the Python module: arrays in and out, every stage as a
function, the sparse factorisation on SciPy matrices." DEPENDS library
    PACKAGES "python3 (>= 3.9), python3-numpy, python3-cffi" SUGGESTS python3-scipy
    SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/postinst ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
endif()
foreach(_plugin "embree|closest points and rays by Embree"
        "opensubdiv|quads as Catmull-Clark cages, by OpenSubdiv"
        "mumps|solver for matrices beyond one machine, by MUMPS and MPI")
  string(REPLACE "|" ";" _plugin "${_plugin}")
  list(POP_FRONT _plugin _name)
  if(TARGET qc_${_name})
    qc_package(${_name} quadcover-plugin-${_name} graphics
      "quad meshing by field-guided parameterization - plugin ${_name}"
      "${_text}This package has a plugin:
${_plugin}." DEPENDS library)
  endif()
endforeach()
include(CPack)
