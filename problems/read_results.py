# Reads the levels of a sweep (needs python3-numpy): python3 problems/read_results.py out/first-mode
import csv, sys
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "out/first-mode"
with open(folder + "/levels.csv", newline="") as table:
    rows = [row for row in csv.DictReader(table) if row["verdict"] == "admissible" and row["level"]]
frequency, energy, force = (np.array([float(row[name]) for row in rows])
                            for name in ("frequency_hz", "energy_joule", "peak_force_n"))
hard = force.argmax()
print("orbits at a level: %d, %.6g to %.6g Hz" % (len(rows), frequency.min(), frequency.max()))
print("largest force %.6g N at %.6g J, %.6g Hz" % (force[hard], energy[hard], frequency[hard]))
