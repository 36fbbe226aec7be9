#!/bin/sh
# tests/bench/run.sh [BUILD]: builds the benchmarks in BUILD (default build/release), runs them one after another and
# writes data/bench/scale.csv (every time) and data/bench/scale.md (machine, versions, growth beside what is expected).
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$top/build/release}
cmake --build "$build" --target nsma_benchmarks nsma_app
out=$top/data/bench
mkdir -p "$out"
bench=$(find "$build" -name nsma_bench -type f | head -1)
"$bench" --benchmark_format=csv --benchmark_min_time=0.2 > "$out/scale.csv" 2> "$build/scale.log"
{
    echo "# How time grows"
    echo
    echo "Written by tests/bench/run.sh. Times are of one core while nothing else should run; load at the start: $(cut -d' ' -f1-3 /proc/loadavg)."
    echo
    echo "- machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
    echo "- compiler: $(c++ --version | head -1), $(sed -n 's/^CMAKE_BUILD_TYPE[^=]*=//p' "$build/CMakeCache.txt")"
    echo "- versions: $("$build/nsma" --version)"
    echo
    echo "The exponent is the slope of log time against log of the number after the slash, by least squares over all its values."
    echo
    echo "| benchmark | times [ms] | exponent | expected |"
    echo "|---|---|---|---|"
    awk -F, '
        BEGIN {
            split("sieve 2 scan_linear 3+ scan_certified 3 kernel_exact 1 kernel_dense 3 march_queue 1 march_dense 3 serve 1 solve_condensed 3 solve_lifted 1 whole_orbit 3", words, " ")
            for (i = 1; i in words; i += 2) expected[words[i]] = words[i + 1]
        }
        { gsub(/"/, "", $1) }
        split($1, part, "/") >= 2 && $3 + 0 > 0 {
            unit = $5 == "ns" ? 1e-6 : $5 == "us" ? 1e-3 : 1
            name = part[1]; x = log(part[2]); y = log($3 * unit)
            if (!(name in n)) order[++count] = name
            ++n[name]; sx[name] += x; sy[name] += y; sxx[name] += x * x; sxy[name] += x * y
            times[name] = times[name] sprintf("%s%d: %.4g", times[name] == "" ? "" : ", ", part[2], $3 * unit)
        }
        END {
            for (i = 1; i <= count; ++i) {
                name = order[i]; d = n[name] * sxx[name] - sx[name] ^ 2
                slope = d > 0 ? sprintf("%.2f", (n[name] * sxy[name] - sx[name] * sy[name]) / d) : "-"
                printf "| %s | %s | %s | %s |\n", name, times[name], slope, (name in expected) ? expected[name] : "-"
            }
        }' "$out/scale.csv"
    cat <<'END'

What is measured:

- `sieve`: all 8 N^2 patterns with n_T <= 4N; N = 1000 is 7 998 000 patterns.
- `scan_linear`: verdict and least energy of all of them, by linear program and least norm where the sieve leaves one;
  `scan_certified`: in closed form, each with its exact certificate, written and checked.
- `kernel_exact` against `kernel_dense` (singular values), `march_queue` against `march_dense` (matrix times vector), one
  period each. Small kernels are dominated by their allocations, so the exponent is below 1.
- `solve_ipopt`, `solve_nlopt` (SLSQP): one call from one start; the iterations differ from m to m, so no exponent is expected.
- `solve_condensed`, `solve_lifted`: Ipopt on the same program with two places a class, n_T = 4N, m = 0.8 N, from the same
  start, at most 150 iterations. The lifted form is chosen from 100 rows on where the condensed one has 8 times its
  nonzeros (`prefers_lifted`).
- `whole_orbit`: the same patterns (m = 400 has N = 500) from the four integers to the replayed orbit, by Ipopt.
- `serve`: what rank 0 does for one result of N = 12 and 48: read, store and commit, pack the next unit.
END
} > "$out/scale.md"
cat "$out/scale.md"
