#!/bin/sh
set -eu

usage() {
    cat <<'END'
usage: sh problems/run.sh

From a bare Debian 12 machine to the first nonsmooth mode of the bar:
  1. installs the packages that are missing (sudo only if not root);
  2. builds the program: build/release/nsma;
  3. sweeps problems/first-mode.toml, every orbit by both solvers: table and charts in out/first-mode/.
It may be run again at any time; what is done already is not done twice.
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

install_packages

say "building build/release/nsma"
cmake --preset release
cmake --build --preset release --target nsma_app

say "sweeping problems/first-mode.toml"
build/release/nsma sweep problems/first-mode.toml --solver both --out out/first-mode --fresh

say "results in $top/out/first-mode:"
ls -1 out/first-mode
