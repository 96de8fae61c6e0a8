# cmake -DINPUT=viewer.html -DOUTPUT=viewer.c -P embed.cmake: a file as a C array, with a zero at the end.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "/* Made from report/viewer.html. */
#include \"bindings/cli/report.h\"
const char cli_viewer[] = {
${bytes}0};
")
