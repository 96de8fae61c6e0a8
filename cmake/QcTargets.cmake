# One helper per kind of target: layers of the SDK, stages, the library itself, tests.

add_library(qc_flags INTERFACE)
target_compile_options(qc_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  $<$<BOOL:${QC_WERROR}>:-Werror>
  # Complex products without the NaN/Inf recovery of Annex G: all operands here are finite.
  $<$<C_COMPILER_ID:GNU>:-fcx-limited-range>
  $<$<C_COMPILER_ID:Clang>:-ffp-contract=off>
  # No contraction: the same bits from every code path and compiler setting.
  $<$<C_COMPILER_ID:GNU>:-ffp-contract=off>)
target_compile_definitions(qc_flags INTERFACE _POSIX_C_SOURCE=200809L)
if(QC_SANITIZE)
  target_compile_options(qc_flags INTERFACE -fsanitize=${QC_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(qc_flags INTERFACE -fsanitize=${QC_SANITIZE})
endif()

set_property(GLOBAL PROPERTY QC_OBJECT_LIBRARIES "")

function(_qc_add_objects target)
  add_library(${target} OBJECT ${ARGN})
  target_link_libraries(${target} PRIVATE qc_flags)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/sdk/include ${PROJECT_SOURCE_DIR})
  set_property(GLOBAL APPEND PROPERTY QC_OBJECT_LIBRARIES ${target})
endfunction()

# qc_add_layer(mesh a.c b.c ...): one folder of sdk/.
function(qc_add_layer name)
  _qc_add_objects(qc_layer_${name} ${ARGN})
endfunction()

# qc_add_stage(field/curvature a.c ...): one folder of stages/.
function(qc_add_stage name)
  string(REPLACE "/" "_" target ${name})
  _qc_add_objects(qc_stage_${target} ${ARGN})
endfunction()

# The shared library (public symbols only) and a static twin for unit tests of internals.
function(qc_add_library)
  get_property(objects GLOBAL PROPERTY QC_OBJECT_LIBRARIES)
  set(sources "")
  foreach(object ${objects})
    list(APPEND sources $<TARGET_OBJECTS:${object}>)
  endforeach()
  foreach(kind SHARED STATIC)
    string(TOLOWER ${kind} suffix)
    add_library(quadcover_${suffix} ${kind} ${sources})
    target_include_directories(quadcover_${suffix} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/sdk/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(quadcover_${suffix} PRIVATE ${QC_PRIVATE_LIBRARIES})
    if(QC_SANITIZE)
      target_link_options(quadcover_${suffix} PUBLIC -fsanitize=${QC_SANITIZE})
    endif()
  endforeach()
  set_target_properties(quadcover_shared PROPERTIES OUTPUT_NAME quadcover EXPORT_NAME quadcover
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  set_target_properties(quadcover_static PROPERTIES OUTPUT_NAME quadcover_internals)
  add_library(QuadCover::quadcover ALIAS quadcover_shared)
endfunction()

# qc_add_test(updown_test.c [more.c ...]): one cmocka program of one or more
# sources, linked to the static twin.
function(qc_add_test source)
  string(REGEX REPLACE "\\.c$" "" name ${source})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  if(folder)
    set(name ${folder}/${name})
  endif()
  string(REPLACE "/" "_" target ${name})
  add_executable(${target} ${source} ${ARGN})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${target} PRIVATE qc_flags quadcover_static ${QC_CMOCKA} m)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND ${target})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
endfunction()
