#!/bin/sh
# format.sh format: rewrites the tracked C and C++ sources; format.sh check-format: fails when that would
# change one.
set -eu
cd "$(dirname "$0")/.."
case ${1:-check-format} in
format) set -- -i ;;
*) set -- --dry-run --Werror ;;
esac
git ls-files -z -- '*.c' '*.h' '*.cpp' '*.hpp' | xargs -0 clang-format "$@"
