#!/bin/sh
# tests/bench/run.sh [BUILD]: builds the benchmarks in BUILD (default build/release) and runs them one after another, some
# ten minutes. Writes data/bench/scale.csv (every benchmark), whole.csv and solves.csv (whole runs of the program, and the
# solver calls of one of them), schedule.csv (that sweep on up to 1000 ranks) and scale.md, which puts them side by side.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$top/build/release}
cmake --build "$build" --target nsma_benchmarks nsma_app
tools=$(dirname "$(find "$build" -name nsma_bench -type f | head -1)")
nsma=$build/nsma
out=$top/data/bench
runs=$build/bench-runs
rm -rf "$runs"
mkdir -p "$out" "$runs"
# For mpirun in a container, where everyone is root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

"$tools/nsma_bench" --benchmark_format=csv --benchmark_min_time=0.2 > "$out/scale.csv" 2> "$runs/scale.log"

scene=$top/problems/full-spectrum.toml
sed 's/^cells = .*/cells = 20/' "$scene" > "$runs/twenty.toml"
sed 's/^count = .*/count = 48/' "$scene" > "$runs/levels.toml"
whole() {  # NAME COMMAND...: a row of whole.csv
    name=$1
    shift
    echo "$name" >&2
    row=$("$tools/nsma_measure" "$@")
    echo "$name,$row" >> "$out/whole.csv"
}
echo "run,wall_s,cpu_s,peak_mb" > "$out/whole.csv"
for turn in 1 2 3; do
    whole "full spectrum" "$nsma" sweep "$scene" --quiet --out "$runs/contact"
    whole "full spectrum certified" "$nsma" sweep "$scene" --certify --quiet --out "$runs/certified"
    whole "full spectrum by both solvers" "$nsma" sweep "$scene" --solver both --quiet --out "$runs/both"
    whole "all kinds by both solvers alone" "$nsma" sweep "$scene" --all-kinds --solver both --quiet --out "$runs/alone"
    whole "all kinds by both solvers on 2 ranks" mpirun -n 2 "$nsma" sweep "$scene" --all-kinds --solver both --quiet --out "$runs/two"
    for table in patterns.csv levels.csv orbits.jsonl; do cmp "$runs/alone/$table" "$runs/two/$table"; done
done
whole "full spectrum (48 levels)" "$nsma" sweep "$runs/levels.toml" --quiet --out "$runs/many"
whole "N = 20 by both solvers" "$nsma" sweep "$runs/twenty.toml" --solver both --quiet --out "$runs/twenty"
# First-mode patterns (5m/2, 6m, 2m) at 1.3 E_min = 32.5 E_g.
for m in 50 100 200 400; do
    for solver in proof ipopt; do
        whole "one level of m = $m by --solver $solver" "$nsma" orbit "$scene" --cells $((5 * m / 2)) --free $((6 * m)) \
            --contact $((2 * m)) --energy 32.5 --solver $solver
    done
done
for service in 2e-4 5e-5; do
    "$tools/nsma_schedule" "$runs/alone/timings.csv" 1000000 $service 2e-6 > "$runs/schedule-$service.csv"
done
cut -d, -f5 "$runs/schedule-5e-5.csv" | sed 's/$/_at_50_us/; 2,$s/_at_50_us//' |
    paste -d, "$runs/schedule-2e-4.csv" - > "$out/schedule.csv"

# Calls of each solver in the sweep of N = 20, patterns with m <= 20.
awk -F, '
    /^#/ || /^cells/ || /^free_steps/ { next }
    FILENAME ~ /patterns/ { m[$3 "," $4] = $6; next }
    $4 ~ /ipopt|nlopt/ && m[$1 "," $2] <= 20 {
        print $4 "," $7 "," $8 * 1000
        if ($4 != "ipopt") next
        print $4 ($5 < 0 ? " from the level before" : $5 == 0 ? " from a point of the level" : " again") "," $7 "," $8 * 1000
    }
' "$runs/twenty/patterns.csv" "$runs/twenty/timings.csv" | sort -t, -k1,1 -k3,3g | awk -F, '
    function row() {
        if (n) printf "%s,%d,%.3f,%d,%.3f\n", name, n, t[int((n + 1) / 2)], it[int((n + 1) / 2)], t[int(0.9 * n + 0.5)]
    }
    BEGIN { print "solver,calls,median_ms,its_iterations,p90_ms" }
    $1 != name { row(); name = $1; n = 0 }
    { ++n; it[n] = $2; t[n] = $3 }
    END { row() }' > "$out/solves.csv"

table() { awk -F, 'NR == 1 { gsub(/_/, " ") } { line = "|"; for (i = 1; i <= NF; ++i) line = line " " $i " |"; print line }
    NR == 1 { line = "|"; for (i = 1; i <= NF; ++i) line = line "---|"; print line }' "$1"; }
{
    echo "# How time grows"
    echo
    echo "Written by tests/bench/run.sh. Times are those of a machine that should do nothing else; its load at the end:"
    echo "$(cut -d' ' -f1-3 /proc/loadavg)."
    echo
    echo "- machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
    echo "- compiler: $(c++ --version | head -1), $(sed -n 's/^CMAKE_BUILD_TYPE[^=]*=//p' "$build/CMakeCache.txt")"
    echo "- versions: $("$nsma" --version)"
    echo
    echo "The exponent is the slope of log time against log of the number before the colon, by least squares over all its values."
    echo
    echo "| benchmark | CPU times [ms] | exponent | expected |"
    echo "|---|---|---|---|"
    awk -F, '
        BEGIN {
            split("sieve 2 scan_integers 2 scan_certified 3 mode_integers 2 mode_certified 2 kernel_exact 1 kernel_dense 3 march_queue 1 march_dense 3 march_tip 1 march_distributed 2 march_cells 2 serve 0 whole_orbit 1 certify_orbit 2 check_orbit 2", words, " ")
            for (i = 1; i in words; i += 2) expected[words[i]] = words[i + 1]
        }
        { gsub(/"/, "", $1) }
        split($1, part, "/") >= 2 && $4 + 0 > 0 {
            unit = $5 == "ns" ? 1e-6 : $5 == "us" ? 1e-3 : 1
            name = part[1]; x = log(part[2]); y = log($4 * unit)
            if (!(name in n)) order[++count] = name
            ++n[name]; sx[name] += x; sy[name] += y; sxx[name] += x * x; sxy[name] += x * y
            times[name] = times[name] sprintf("%s%d: %.4g", times[name] == "" ? "" : ", ", part[2], $4 * unit)
        }
        END {
            for (i = 1; i <= count; ++i) {
                name = order[i]; d = n[name] * sxx[name] - sx[name] ^ 2
                slope = d > 0 ? sprintf("%.2f", (n[name] * sxy[name] - sx[name] * sy[name]) / d) : "-"
                printf "| %s | %s | %s | %s |\n", name, times[name], slope, (name in expected) ? expected[name] : "-"
            }
        }' "$out/scale.csv"
    cat <<'END'

What is measured, and what to read in it:

- `sieve`: all 8 N^2 patterns with n_T <= 4N; N = 1000 is 7 998 000 patterns.
- `scan_integers`, `scan_certified`: verdict, kind and interval of all patterns, by the sieve alone and each with its exact
  certificate, written and checked in n_T steps; `mode_integers`, `mode_certified`: of the N - 1 patterns of the first mode.
- `kernel_exact` against `kernel_dense` (singular values), `march_queue` against `march_dense` (matrix times vector), one
  period each. Small kernels are dominated by their allocations, so the exponent is below 1.
- `march_tip`, `march_distributed`: the same period under a force, with a dashpot at the tip and with damped cells, against
  `march_cells`, the literal cell update without either.
- `solve_ipopt`, `solve_nlopt` (SLSQP): one call from one start on the first-mode pattern (5m/2, 6m, 2m).
- `whole_orbit`: the same patterns at 1.3 E_min, from the four integers to the replayed orbit, with the exact proof of the
  interval and the closed form of the optimum.
- `certify_orbit`, `check_orbit`: making and checking the certificate that this orbit has the least shock. It covers all m
  columns, over which the integers of the check grow to 44 m/2 bits.
- `serve`: what rank 0 does for one answer: read, store and commit, choose and pack the next unit; a million levels a
  pattern. `serve_verdicts`: reading and storing all verdicts of N = 12 and 48 (`scale.csv` has
  the number of messages).

## Whole runs

From start to exit, tables and charts included; memory is that of the largest process.

END
    table "$out/whole.csv"
    cat <<'END'

The full spectrum (N = 12, 12 levels) by one process and by two takes turns, so that a machine that changes its speed
changes it for both; their tables are compared byte by byte. Contact motions are closed forms: what is worth sharing are
free patterns by both solvers. mpirun waits two seconds after an exit code other than 0.

Calls of the solvers in the sweep of N = 20, m <= 20 (wall time; the first level of eight starts from a
point of its own, and so do further starts where the solvers differ):

END
    table "$out/solves.csv"
    cat <<'END'

A million answers on 1 to 1000 ranks, from the times of the sweep alone, 0.2 ms at rank 0 for a message
and 2 us latency; last, with 0.05 ms at rank 0:

END
    table "$out/schedule.csv"
} > "$out/scale.md"
cat "$out/scale.md"
