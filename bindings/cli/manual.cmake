# cmake -DPROGRAM=quadcover -DOUTPUT=quadcover.1 -P manual.cmake: the manual page, from what the
# program says about itself and its commands.
function(section title)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  string(STRIP "${help}" help)
  set(HELP "${help}" PARENT_SCOPE)
  string(REPLACE "\\" "\\e" help "${help}")
  string(REPLACE "-" "\\-" help "${help}")
  string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" help "\n${help}") # no requests
  file(APPEND ${OUTPUT} ".SH ${title}\n.nf${help}\n.fi\n")
endfunction()

execute_process(COMMAND ${PROGRAM} --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "\n.*" "" version "${version}")
file(WRITE ${OUTPUT} ".TH QUADCOVER 1 \"\" \"${version}\" \"User commands\"
.SH NAME
quadcover \\- triangle mesh to quad mesh by field\\-guided parameterization
")
section(SYNOPSIS)
string(REGEX MATCHALL "\n  [a-z]+  +" commands "${HELP}")
if(NOT commands)
  message(FATAL_ERROR "no commands in the output of ${PROGRAM} --help")
endif()
foreach(command ${commands})
  string(STRIP "${command}" command)
  string(TOUPPER ${command} title)
  section(${title} ${command})
endforeach()
