#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/price/relaxed_set.hpp"
#include "nsma/price/shadow_prices.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// What a derivative is taken along. Row parameters name one row of COND1 or COND3, the others
/// move a whole condition.
enum class Parameter {
    cond1_row,    ///< clearance of the wall at the steps of one row [m]
    cond3_row,    ///< tension allowed in the steps of one row [N]
    gap,          ///< the gap d itself [m]
    contact,      ///< place of contact, x = d + value in contact, wall in flight at d [m]
    band,         ///< half width of COND2 as a band [m]
    penetration,  ///< allowed beyond the wall in flight, all of COND1 [m]
    adhesion,     ///< tension allowed in all contact steps [N]
    energy        ///< level of the energy [J]
};
/// "cond1" and "cond3" of a row; "gap", "contact", "band", "penetration", "adhesion", "energy".
[[nodiscard]] std::string_view name(Parameter parameter);
/// Unit of the parameter in SI: displacement, force or energy unit of the bar.
[[nodiscard]] double unit_of(Parameter parameter, const Bar& bar);

/// One derivative, nondimensional (see Slope).
struct Price {
    Parameter parameter = Parameter::gap;  ///< along which
    std::vector<int> steps;                ///< of a row
    bool active = true;                    ///< rows: at equality
    Slope slope;                           ///< of the objective
};

/// dbeta along one parameter.
struct OrbitDerivative {
    Parameter parameter = Parameter::gap;  ///< along which
    OrbitSlope slope;                      ///< of beta
};

/// One optimum with its shadow prices.
struct OptimumRecord {
    Orbit orbit;                                   ///< the optimum
    Objective objective = Objective::least_shock;  ///< min_energy without a level
    std::optional<double> level;                   ///< E/E_unit
    double value = 0;                              ///< nondimensional objective
    bool global = false;                           ///< proved to be the best orbit
    bool nondegenerate = false;                    ///< independent active rows, positive multipliers
    int tied = 1;                        ///< optima of this value that symmetries give, this one included; 0: too many
    std::string refusal;                 ///< nothing can be said: why
    std::optional<double> kkt_residual;  ///< relative; absent without multipliers
    std::optional<double> euler_defect;  ///< relative
    std::vector<Price> prices;           ///< of whole conditions, then of rows
    std::vector<OrbitDerivative> derivatives;  ///< along whole conditions, the band left out
};

/// Ends of the energy interval of a pattern, in the energy unit, and their derivatives; for a
/// pattern of a nonsmooth mode also its frequency at fixed energy, exact and from the stored
/// neighbours on the mesh (theory: T/tau = ((2k+1) + d sqrt(Y S/(2 L E)))/k^2).
struct IntervalRecord {
    Pattern pattern;                                       ///< (N, r, p)
    double least = 0;                                      ///< E_min/E_unit
    std::optional<double> greatest;                        ///< absent: unbounded
    std::vector<Price> least_prices;                       ///< of E_min
    std::vector<Price> greatest_prices;                    ///< of E_max; empty when unbounded
    std::optional<int> mode;                               ///< k of a pattern of a nonsmooth mode
    std::optional<double> frequency_by_energy;             ///< E/omega domega/dE, exact
    std::optional<double> frequency_by_energy_difference;  ///< the same from stored neighbours
    std::optional<double> frequency_by_gap;                ///< d/omega domega/dd at fixed energy, exact
    std::optional<double> frequency_by_gap_difference;     ///< the same from stored neighbours
};

/// One point of a relaxation curve of one pattern; amounts in u and Y S u/L.
struct CurveRecord {
    Pattern pattern;                  ///< (N, r, p)
    std::string relaxed;              ///< "penetration", "band+adhesion", ...
    double amount = 0;                ///< by which each of them is relaxed
    bool failed = false;              ///< a linear program failed: nothing is known
    bool admissible = false;          ///< some orbit meets what is left
    std::optional<double> least;      ///< E_min
    std::optional<double> greatest;   ///< E_max; absent: unbounded or not admissible
    bool unbounded = false;           ///< no greatest energy
    std::optional<double> level;      ///< of the objective
    std::optional<double> objective;  ///< best found at the level
};

/// Which conditions a pattern survives: a nonzero beta that meets them exists. Bit 0: COND1,
/// bit 1: COND2, bit 2: COND3; survives[0] is the kernel alone.
struct AblationRecord {
    Pattern pattern;                  ///< (N, r, p)
    int kernel_dimension = 0;         ///< m
    std::optional<PatternKind> kind;  ///< of the motions of the kernel, admissible or not; absent for a trivial one
    std::array<bool, 8> survives{};   ///< by the bits of the conditions kept
};

/// What a study is asked for.
struct SensitivityRequest {
    std::optional<Pattern> pattern;  ///< absent: every pattern of the scene
    std::optional<double> level;     ///< with a pattern: its level; absent: the least energy
    OrbitSolverOptions solver;       ///< of the optima
    /// Relaxations of the curves, in u and Y S u/L.
    std::vector<double> amounts{0, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5};
};

/// Counts and worst defects of a study.
struct SensitivitySummary {
    int patterns = 0;            ///< visited
    int admissible = 0;          ///< some orbit
    int optima = 0;              ///< analysed
    int left = 0;                ///< admissible, but no contact motion: only its ablation
    int nondegenerate = 0;       ///< optima with unique positive multipliers
    int tied = 0;                ///< optima that others tie with
    int refused = 0;             ///< optima of which nothing can be said
    int failed = 0;              ///< admissible by verdict, yet no orbit was found
    double worst_euler = 0;      ///< relative
    double worst_kkt = 0;        ///< relative
    double worst_frequency = 0;  ///< exact against stored neighbours, relative
    bool interrupted = false;    ///< ended before its last pattern
};

/// Everything a study found, in the order it came.
struct SensitivityRecords {
    std::vector<OptimumRecord> optima;      ///< one a pattern and level
    std::vector<IntervalRecord> intervals;  ///< one a solved pattern, gap != 0
    std::vector<CurveRecord> curves;        ///< one a pattern, relaxation and amount, gap != 0
    std::vector<AblationRecord> ablations;  ///< one a pattern
    SensitivitySummary summary;             ///< of all of them
};

/// The study: prices and orbit derivatives of every optimum, the energy intervals, relaxation
/// curves (each condition alone and in pairs) and the ablation funnel. Relaxation curves are
/// left out for a closed gap, where no length tells how much is much. `progress` is told how many patterns of how many
/// are done.
[[nodiscard]] SensitivityRecords sensitivity(const Scene& scene, const SensitivityRequest& request,
                                             const std::function<bool()>& keep_going,
                                             const std::function<void(long done, long total)>& progress = {});

/// All derivatives of one optimum; `level` absent: of its energy (objective min_energy).
[[nodiscard]] OptimumRecord optimum_record(const Orbit& orbit, int gap_sign, Objective objective,
                                           std::optional<double> level, const Eigen::VectorXd& reference = {});

/// Decides every subset of COND1-3 by a linear program.
/// Throws std::invalid_argument on a gap sign other than -1, 0, 1.
[[nodiscard]] AblationRecord ablation_record(const Kernel& kernel, int gap_sign);

/// Energy interval with its derivatives; the frequency fields are those of the closed form.
[[nodiscard]] IntervalRecord interval_record(const RelaxedSet& set);

}  // namespace nsma
