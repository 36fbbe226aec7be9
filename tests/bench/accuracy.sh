#!/bin/sh
# tests/bench/accuracy.sh [BUILD]: builds nsma in BUILD (default build/release), runs the accuracy study there (some ten
# minutes) and copies its tables to data/bench/accuracy and its first chart to data/pictures; data/accuracy.md quotes them.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$top/build/release}
cmake --build "$build" --target nsma_app
rm -rf "$build/accuracy"
"$build/nsma" accuracy "$top/problems/first-mode.toml" --out "$build/accuracy"
mkdir -p "$top/data/bench/accuracy"
cp "$build"/accuracy/*.csv "$build/accuracy/machine.txt" "$build/accuracy/scene.toml" "$top/data/bench/accuracy/"
cp "$build/accuracy/charts/accuracy-programs.png" "$top/data/pictures/"
