# Reads the levels of a sweep: julia problems/read_results.jl out/first-mode
using Printf

folder = isempty(ARGS) ? "out/first-mode" : ARGS[1]
fields(line) = [m.captures[1] for m in eachmatch(r"(\"[^\"]*\"|[^,]*),", line * ",")]
names, rows... = fields.(readlines(folder * "/levels.csv"))
place(name) = findfirst(==(name), names)
rows = filter(row -> row[place("verdict")] == "admissible" && row[place("level")] != "", rows)
frequency, energy, force = [parse.(Float64, getindex.(rows, place(name))) for name in ("frequency_hz", "energy_joule", "peak_force_n")]
hard = argmax(force)
@printf("orbits at a level: %d, %.6g to %.6g Hz\n", length(rows), minimum(frequency), maximum(frequency))
@printf("largest force %.6g N at %.6g J, %.6g Hz\n", force[hard], energy[hard], frequency[hard])
