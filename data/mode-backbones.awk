# Exact nonsmooth modes on the meshes N of the command line: awk -f data/mode-backbones.awk 20 120 > data/mode-backbones.csv
# Mode k, n_T steps a period: r = 2 (k n_T - 2 N), p = 4 N - (2 k - 1) n_T, w = k^2 n_T - (2 k + 1) N,
# sign of the gap = sign of w, E/E_g = N^2 / w^2, omega/omega_1 = 4 N / n_T. r, p >= 1 and w != 0.
BEGIN {
    OFS = ","
    print "mode,gap_sign,cells,period_steps,free_steps,contact_steps,frequency_ratio,energy_numerator,energy_denominator,energy_ratio"
    for (argument = 1; argument < ARGC; ++argument) {
        n = ARGV[argument]
        for (sign = 1; sign >= -1; sign -= 2)
            for (k = 1; k <= 4; ++k)
                for (t = 2; t <= 4 * n; ++t) {
                    r = 2 * (k * t - 2 * n); p = 4 * n - (2 * k - 1) * t; w = k * k * t - (2 * k + 1) * n
                    if (r >= 1 && p >= 1 && w * sign > 0)
                        print k, sign, n, t, r, p, sprintf("%.17g", 4 * n / t), n * n, w * w, sprintf("%.17g", n * n / (w * w))
                }
    }
    exit
}
