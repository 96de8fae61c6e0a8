#!/bin/sh
# headers.sh INCLUDE_FOLDER COMPILER [FLAGS]: compiles each qc/*.h by itself.
include=$1
shift
bad=0
for header in "$include"/qc/*.h; do
    name=qc/$(basename "$header")
    printf '#include <%s>\n#include <%s>\nint main(void) { return 0; }\n' "$name" "$name" |
        "$@" -Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -I "$include" - ||
        { echo "$name does not compile alone"; bad=1; }
done
exit $bad
