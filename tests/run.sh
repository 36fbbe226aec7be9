#!/bin/sh
set -eu

usage() {
    cat <<'END'
usage: sh tests/run.sh [release|debug|clang|lint|fuzz ...]

Installs the packages that are missing (sudo only if not root), then configures, builds and tests each preset named;
without a name release, then debug (address and undefined-behaviour sanitizers), then lint (tests/lint.sh: formatting,
clang-tidy, reference pages), then fuzz (tests/fuzz/run.sh: hostile input, made up for a minute). It may be run again at any time.
END
}

for preset in "$@"; do
    case "$preset" in
        release | debug | clang | lint | fuzz) ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; exit 2 ;;
    esac
done
[ $# -gt 0 ] || set -- release debug lint fuzz

top=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
cd "$top"
. problems/setup.sh
packages="$packages python3-numpy"  # a program of problems/ reads results with it
packages="$packages chromium"       # the report is opened in it
case " $* " in *" clang "*) packages="$packages clang" ;; esac

install_packages

for preset in "$@"; do
    case "$preset" in
        lint) sh tests/lint.sh; continue ;;
        fuzz) sh tests/fuzz/run.sh; continue ;;
    esac
    say "building and testing the preset $preset"
    cmake --workflow --preset "$preset"
done
say "all tests passed: $*"
