#!/bin/sh
set -eu

usage() {
    cat <<'END'
usage: sh tests/lint.sh

Installs what is missing (sudo only if not root), then fails on a source that clang-format would change, on any finding of
eslint and tidy in the page of the report, or of clang-tidy in the library and the program, and on any warning of Doxygen about the reference of the public headers (build/lint/reference/html).
END
}

case "${1-}" in
    '') ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
esac

top=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
cd "$top"
. problems/setup.sh
packages="$packages clang-format clang-tidy doxygen eslint tidy"
install_packages

say "clang-format"
find include src tests -name '*.[ch]pp' -exec clang-format --dry-run -Werror {} +
clang-format --dry-run -Werror src/report/page/*.js

say "eslint, tidy"
# A Node.js from elsewhere does not look where Debian's modules are.
NODE_PATH=/usr/share/nodejs eslint --format unix --max-warnings 0 src/report/page/*.js
sed 's:@[A-Z]*@:/**/:' src/report/page/page.html | tidy -quiet -errors

say "clang-tidy"
cmake --preset lint > /dev/null
cmake --build --preset lint --target nsma_page > /dev/null  # a source that is made
sed -n 's/.*"file": "\(.*\)".*/\1/p' build/lint/compile_commands.json |
    tr '\n' '\0' | xargs -0 -P "$(nproc)" -n 1 clang-tidy -p build/lint --quiet --warnings-as-errors='*' \
        --extra-arg=-Wno-unknown-warning-option

say "doxygen"
cmake --build --preset lint --target nsma_reference
