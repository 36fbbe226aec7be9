#!/bin/sh
set -eu

usage() {
    cat <<'END'
usage: sh tests/fuzz/run.sh [SECONDS]

Installs what is missing (sudo only if not root), builds the fuzz targets with clang++ (libFuzzer, address and
undefined-behaviour sanitizers) and runs each on the kept corpus and for SECONDS more, 60 unless said, all at once. What
they find is build/fuzz/NAME-crash-*; new inputs of worth are in build/fuzz/corpus/NAME, and
  build/fuzz/tests/fuzz/nsma_NAME_fuzz -merge=1 tests/fuzz/corpus/NAME build/fuzz/corpus/NAME
keeps those that reach new code.
END
}

case "${1-60}" in
    -h | --help) usage; exit 0 ;;
    *[!0-9]*) usage >&2; exit 2 ;;
esac
seconds=${1-60}

top=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
cd "$top"
. problems/setup.sh
packages="$packages clang libclang-rt-14-dev"  # which clang only recommends
install_packages

say "building the fuzz targets"
cmake --preset fuzz
cmake --build --preset fuzz

say "fuzzing for $seconds s"
for name in scene certificate store study command_line; do
    mkdir -p "build/fuzz/corpus/$name"
    seeds=""
    [ "$name" = scene ] && seeds=problems
    # shellcheck disable=SC2086  # none or one folder
    build/fuzz/tests/fuzz/nsma_${name}_fuzz -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=20000 \
        -artifact_prefix="build/fuzz/$name-" "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" $seeds \
        > "build/fuzz/$name.log" 2>&1 &
    eval "process_$name=\$!"
done
failed=""
for name in scene certificate store study command_line; do
    eval "wait \$process_$name" || failed="$failed $name"
    tail -n 1 "build/fuzz/$name.log"
done
for name in $failed; do
    say "found something: $name" >&2
    tail -n 40 "build/fuzz/$name.log" >&2
done
[ -z "$failed" ]
