# The wheel as a package of the distribution: without the library, which is a package of its own and
# is found where libraries are, and without pip's list of files. Variables: wheel_folder, strip.
set(_site $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/python3/dist-packages)
file(GLOB _wheel ${wheel_folder}/quadcover-*.whl)
message(STATUS "Installing: ${_site}/quadcover")
file(ARCHIVE_EXTRACT INPUT ${_wheel} DESTINATION ${_site})
file(GLOB _other ${_site}/quadcover/libquadcover.* ${_site}/quadcover-*.dist-info/RECORD)
file(REMOVE ${_other})
file(GLOB _extension ${_site}/quadcover/_c.*so)
file(RPATH_REMOVE FILE ${_extension})
if(CMAKE_INSTALL_DO_STRIP)
  execute_process(COMMAND ${strip} ${_extension} COMMAND_ERROR_IS_FATAL ANY)
endif()
# Archives do not keep permissions.
file(GLOB_RECURSE _files ${_site}/quadcover/* ${_site}/quadcover-*.dist-info/*)
file(CHMOD ${_files} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
