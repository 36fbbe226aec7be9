// The ways in which Ipopt and NLopt are known to fail, by their number in the table the project
// started from. Each test asserts what we answer; what the library says may change with its version.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../numerics/textbook.hpp"
#include "../support/process.hpp"

#include "numerics/polish.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"

namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Eigen::VectorXd;
using nsma::IpoptSolver;
using nsma::NloptMethod;
using nsma::Objective;
using nsma::OrbitAnswer;
using nsma::OrbitRequest;
using nsma::OrbitSolver;
using nsma::OrbitSolverOptions;
using nsma::Pattern;
using nsma::pattern_problem;
using nsma::Program;
using nsma::solve_with_nlopt;
using nsma::SolverOptions;
using nsma::SolverOutcome;
using nsma::Verdict;
using testing::HasSubstr;

const Vector3d start(0.48, 0.6, 0.64);  // on the unit sphere
const auto all_methods = {NloptMethod::slsqp, NloptMethod::auglag_lbfgs, NloptMethod::cobyla};

OrbitAnswer solve(const Pattern& pattern, double gap, const OrbitRequest& request, OrbitSolverOptions options = {}) {
    nsma::Bar bar;
    bar.gap = gap;
    return OrbitSolver(options).solve(bar, pattern_problem(pattern, bar.gap_sign()), request);
}

void expect_sound(const OrbitAnswer& answer) {
    ASSERT_EQ(answer.verdict, Verdict::admissible) << answer.reason;
    ASSERT_TRUE(answer.orbit && answer.replay);
    const auto judged = nsma::replay(*answer.orbit, answer.level);
    EXPECT_TRUE(judged.accepted);
    EXPECT_LE(judged.violations.worst(), 1e-9);  // the acceptance of the project
}

/// Every answer of every solver to a program.
std::vector<SolverOutcome> outcomes(const Program& program) {
    std::vector<SolverOutcome> all;
    IpoptSolver ipopt;
    all.push_back(ipopt.solve(program, start));
    for (const auto method : all_methods) all.push_back(solve_with_nlopt(method, program, start));
    return all;
}

template <typename Call>
std::string message_of(Call call) {
    try {
        call();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "nothing was thrown";
}

struct Child {
    bool in_time = false;
    int exit_code = 0;  ///< -signal when a signal ended it
    std::string out;
    double seconds = 0;
};

/// Runs solver_child with one argument; after `limit` seconds it is killed, by its own id.
Child run_child(const std::string& name, double limit) {
    const process::Folder folder;
    const auto out = folder.path() / "out";
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = process::start({NSMA_SOLVER_CHILD, name}, out, "/dev/null");
    Child result;
    result.in_time = process::wait_for([child] { return process::ended(child); }, limit);
    if (!result.in_time) kill(child, SIGKILL);
    result.exit_code = process::finish(child);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.out = process::contents(out);
    return result;
}

// A loaded machine takes its time to start a program, more so under sanitizers.
constexpr double patience = 30.0;

TEST(FailureTable, Row01MoreEqualitiesThanUnknowns) {
    // One amplitude with COND2 and an energy: a closed form decides, no solver is called.
    const Pattern pattern{5, 14, 3};
    ASSERT_EQ(nsma::kernel_dimension(pattern), 1);
    const double energy = 25.0 / 4.0;  // 1/(17/5 - 3)^2
    for (const double factor : {0.5, 1.0, 2.0}) {
        const auto answer = solve(pattern, 1, {.level = factor * energy, .reference = {}});
        EXPECT_TRUE(answer.solvers.empty());
        EXPECT_EQ(answer.verdict, factor < 1 ? Verdict::below : factor > 1 ? Verdict::above : Verdict::admissible);
        EXPECT_TRUE(answer.verdict_proved);
    }
    // And should such a program reach one: a status, and no point that counts as feasible.
    auto program = textbook::unit_sphere({1, 0, 0});
    const Eigen::MatrixXd planes = Eigen::Matrix3d::Identity();
    program.equalities = planes.sparseView();
    program.equality_values = Vector3d(0, 0, 2);
    for (const auto& outcome : outcomes(program)) EXPECT_GT(program.violation(outcome.x), 0.5) << outcome.status;
}

TEST(FailureTable, Row02TheSameEqualityTwice) {
    const Pattern pattern{20, 48, 16};  // COND2 holds at 16 contact steps and at step 0
    const auto problem = pattern_problem(pattern, 1);
    const auto program = nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock,
                                             1.5 * *problem.interval.least);
    EXPECT_EQ(program.program.equalities.rows(), 1);
    EXPECT_GE(problem.set.reduction.removed.contact_duplicates, 16);
    expect_sound(solve(pattern, 1, {.level = 1.5 * *problem.interval.least, .reference = {}}));
}

TEST(FailureTable, Row03TheSameEqualityTwiceInconsistent) {
    // x + y + z = 1 and = 1 + 1e-6: every point is off by half of that at least.
    auto program = textbook::circle().program;
    Eigen::MatrixXd twice = Eigen::MatrixXd::Ones(2, 3);
    program.equalities = twice.sparseView();
    program.equality_values = Eigen::Vector2d(1, 1 + 1e-6);
    for (const auto& outcome : outcomes(program)) {
        EXPECT_GE(program.violation(outcome.x), 4.9e-7) << outcome.status;
        if (!outcome.x.allFinite()) continue;
        EXPECT_FALSE(nsma::polish(program, outcome.x).feasible) << outcome.status;
    }
}

TEST(FailureTable, Row04InfeasibleProgram) {
    const auto program = textbook::infeasible();
    for (const auto& outcome : outcomes(program)) {
        EXPECT_GT(program.violation(outcome.x), 1e-2) << outcome.status;
    }
    // A pattern that is not admissible has its Farkas vector; no solver is asked.
    const auto answer = solve({6, 16, 4}, -1, {.level = 12.0, .reference = {}});
    EXPECT_EQ(answer.verdict, Verdict::inadmissible);
    EXPECT_TRUE(answer.verdict_proved);
    EXPECT_TRUE(answer.solvers.empty());
    EXPECT_FALSE(answer.orbit);
}

TEST(FailureTable, Row05SlsqpWithTheEnergyAsObjective) {
    OrbitSolverOptions options;
    options.solvers = nsma::SolverChoice::nlopt;
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {20, 48, 16}}) {
        const auto interval = pattern_problem(pattern, 1).interval;
        for (const auto objective : {Objective::min_energy, Objective::max_energy}) {
            if (objective == Objective::max_energy && interval.unbounded) continue;
            const auto answer = solve(pattern, 1, {.level = {}, .objective = objective, .reference = {}}, options);
            expect_sound(answer);
            const double known = objective == Objective::min_energy ? *interval.least : *interval.greatest;
            EXPECT_NEAR(*answer.energy, known, 1e-9 * known);
            EXPECT_TRUE(answer.solvers.empty());  // closed form: SLSQP is not asked
        }
        // Asked all the same, its word is not taken: what it holds is restored and polished to the least energy.
        const auto problem = pattern_problem(pattern, 1);
        auto program =
            nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, *interval.least);
        program.program.hessian.setIdentity();
        program.program.hessian *= 2.0;
        program.program.sphere_variables = 0;
        const nsma::LevelPoints points(problem.set, *interval.least);
        for (const auto& vertex : problem.set.vertices) {
            const auto outcome =
                nsma::solve_with_nlopt(nsma::NloptMethod::slsqp, program.program, program.point(vertex), {});
            ASSERT_GT(outcome.iterations, 0) << outcome.status;
            const VectorXd near = points.admissible_near(program.gamma(outcome.x));
            const auto polished = nsma::polish(program.program, program.point(near));
            EXPECT_TRUE(polished.feasible && polished.stationary);
            EXPECT_NEAR(polished.objective * program.objective_unit, *interval.least, 1e-9 * *interval.least);
        }
    }
}

TEST(FailureTable, Row06NeverStartsAtRest) {
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {20, 48, 16}}) {
        const auto problem = pattern_problem(pattern, 1);
        const double level = 1.7 * *problem.interval.least;
        const auto program = nsma::orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, level);
        const nsma::LevelPoints points(problem.set, level);
        for (int k = 0; k < 20; ++k) {
            const auto begin = points.start(k);
            ASSERT_TRUE(begin);
            // Feasible and on the sphere before any solver moves; rounding of a few products.
            EXPECT_LE(program.program.violation(program.point(*begin)), 1e-12) << k;
        }
    }
}

TEST(FailureTable, Row07CobylaWithoutXtol) {
    // A tolerance of zero would hang: it is refused before NLopt sees it.
    for (const double tolerance : {0.0, -1.0, std::nan("")}) {
        SolverOptions options;
        options.tolerance = tolerance;
        for (const auto method : all_methods) {
            EXPECT_THAT(message_of([&] { (void)solve_with_nlopt(method, textbook::circle().program, start, options); }),
                        HasSubstr("tolerance: expected > 0"));
        }
    }
    // Ours ends by the clock, whatever else it was allowed.
    for (const char* name : {"cobyla", "auglag", "slsqp"}) {
        const Child child = run_child(name, patience);
        EXPECT_TRUE(child.in_time) << name << " hung";
        EXPECT_EQ(child.exit_code, 0) << name << ": " << child.out;
        double seconds = 0;
        std::istringstream(child.out.substr(child.out.find_last_of(' ') + 1)) >> seconds;
        EXPECT_LT(seconds, 0.05 + 5.0) << name << ": " << child.out;  // the limit, on a busy machine
    }
    // The library alone may hang or not; the limit outside of it holds either way.
    const Child raw = run_child("raw-cobyla", 1.0);
    RecordProperty("raw_cobyla_returned", raw.in_time ? 1 : 0);
    EXPECT_LT(raw.seconds, patience);
}

TEST(FailureTable, Row08AuglagWithoutALocalOptimiser) {
    const Child raw = run_child("raw-auglag", patience);
    RecordProperty("raw_auglag_signal", std::max(0, -raw.exit_code));
    const auto item = textbook::circle();
    const auto outcome = solve_with_nlopt(NloptMethod::auglag_lbfgs, item.program, start);
    EXPECT_LT(item.program.violation(outcome.x), 1e-4) << outcome.status;  // first order multipliers
}

TEST(FailureTable, Row09NotANumberFromAConstraint) {
    // In the data: refused, with the row.
    auto program = textbook::linear_on_cap().program;
    const double nan = std::nan("");
    program.inequalities.coeffRef(0, 1) = nan;
    IpoptSolver ipopt;
    EXPECT_THAT(message_of([&] { (void)ipopt.solve(program, start); }), HasSubstr("row 0"));
    for (const auto method : all_methods) {
        EXPECT_THAT(message_of([&] { (void)solve_with_nlopt(method, program, start); }), HasSubstr("row 0"));
    }
    // By overflow of finite data: not a feasible point, and NLopt's callback names the row.
    program = textbook::linear_on_cap().program;
    program.inequalities = textbook::row({1.7e308, 1.7e308, 1.7e308});
    program.inequality_values = VectorXd::Ones(1);
    for (const auto method : all_methods) {
        const auto outcome = solve_with_nlopt(method, program, start);
        EXPECT_EQ(outcome.status, "non-finite value of inequality 0");
        EXPECT_GT(program.violation(outcome.x), 1e-2);
    }
    EXPECT_GT(program.violation(ipopt.solve(program, start).x), 1e-2);
    // The objective likewise.
    program = textbook::linear_on_sphere().program;
    program.gradient = Vector3d(1.7e308, 1.7e308, 1.7e308);
    for (const auto method : all_methods) {
        EXPECT_EQ(solve_with_nlopt(method, program, start).status, "non-finite value of the objective");
    }
}

TEST(FailureTable, Row10NotANumberInADerivative) {
    // Value zero, gradient infinite minus infinite: H x overflows.
    auto program = textbook::linear_on_sphere().program;
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    hessian.row(0) << 1.7e308, 1.7e308, 1.7e308;
    hessian.col(0) = hessian.row(0);
    program.hessian = hessian.sparseView();
    const auto outcome = IpoptSolver().solve(program, start);
    EXPECT_EQ(outcome.status, "Invalid_Number_Detected");
    for (const auto method : all_methods) {
        const auto other = solve_with_nlopt(method, program, start);
        EXPECT_THAT(other.status, HasSubstr("non-finite value"));
    }
}

TEST(FailureTable, Row11AnExceptionKeepsItsWords) {
    // What a callback of NLopt could not do is the status, not "FORCED_STOP" or "FAILURE".
    auto program = textbook::unit_sphere({1, 0, 0});
    program.equalities = textbook::row({1.7e308, 1.7e308, 1.7e308});
    program.equality_values = VectorXd::Ones(1);
    for (const auto method : all_methods) {
        EXPECT_EQ(solve_with_nlopt(method, program, start).status, "non-finite value of equality 0");
    }
}

TEST(FailureTable, Row12IpoptFromThreads) {
    // In a child it may crash, hang or go well; here nothing of it shows.
    const auto item = textbook::trust_region();
    IpoptSolver solver;
    const VectorXd before = solver.solve(item.program, start).x;
    const Child raw = run_child("threads", 5.0);
    RecordProperty("threads_signal", raw.in_time ? std::max(0, -raw.exit_code) : 0);
    EXPECT_EQ(solver.solve(item.program, start).x, before);
    // One solver a process: nothing that calls a solver makes threads.
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(NSMA_SOURCES)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream stream(entry.path());
        std::stringstream text;
        text << stream.rdbuf();
        ++files;
        // A file that knows nothing of solvers may.
        const bool solves = text.str().find("search/") != std::string::npos ||
                            text.str().find("numerics/solver") != std::string::npos ||
                            text.str().find("price/") != std::string::npos;
        if (entry.path().filename() == "forced_response.cpp" && !solves) continue;
        for (const char* word :
             {"std::thread", "std::jthread", "std::async", "pthread_create", "#pragma omp", "execution::par"}) {
            EXPECT_EQ(text.str().find(word), std::string::npos) << entry.path() << ": " << word;
        }
    }
    EXPECT_GT(files, 50);
}

TEST(FailureTable, Row13NloptFromThreads) {
    const auto items = textbook::all();
    const auto answer = [&](std::size_t i) {
        return solve_with_nlopt(NloptMethod::slsqp, items[i % items.size()].program, start).x;
    };
    std::vector<VectorXd> serial(16);
    std::vector<VectorXd> parallel(16);
    for (std::size_t i = 0; i < serial.size(); ++i) serial[i] = answer(i);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (std::size_t i = t; i < parallel.size(); i += 4) parallel[i] = answer(i);
        });
    }
    for (auto& thread : threads) thread.join();
    for (std::size_t i = 0; i < serial.size(); ++i) EXPECT_EQ(serial[i], parallel[i]) << i;
}

TEST(FailureTable, Row14AnOptionFileInTheWorkingDirectory) {
    const OrbitRequest request{.level = 1.5 * 12.0 / 11.0, .reference = {}};
    OrbitSolverOptions options;
    options.solvers = nsma::SolverChoice::ipopt;
    const auto plain = solve({6, 23, 1}, 1, request, options);
    const fs::path before = fs::current_path();
    std::string name = (fs::temp_directory_path() / "nsma-options-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    std::ofstream(fs::path(name) / "ipopt.opt") << "max_iter 0\ntol 0.5\nbound_relax_factor 0.1\n";
    fs::current_path(name);
    const auto here = solve({6, 23, 1}, 1, request, options);
    fs::current_path(before);
    fs::remove_all(name);
    expect_sound(plain);
    expect_sound(here);
    EXPECT_EQ(plain.orbit->beta, here.orbit->beta);
    ASSERT_EQ(plain.solvers.size(), here.solvers.size());
    for (std::size_t i = 0; i < plain.solvers.size(); ++i)
        EXPECT_EQ(plain.solvers[i].iterations, here.solvers[i].iterations);
}

TEST(FailureTable, Row15StatusesWithoutAPoint) {
    // After a good solve on the same object: nothing of it may be taken for the next answer.
    IpoptSolver solver;
    EXPECT_TRUE(solver.solve(textbook::circle().program, start).x.allFinite());
    auto program = textbook::unit_sphere({1, 0, 0});
    const Eigen::MatrixXd planes = Eigen::Matrix3d::Identity();
    program.equalities = planes.sparseView();
    program.equality_values = Vector3d(0, 0, 1);
    const auto outcome = solver.solve(program, start);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_FALSE(outcome.x.allFinite());
    EXPECT_EQ(program.violation(outcome.x), nsma::no_bound);
    EXPECT_TRUE(solver.solve(textbook::circle().program, start).x.allFinite());
}

TEST(FailureTable, Row16InconsistentBounds) {
    auto program = textbook::circle().program;
    program.lower[2] = 0.5;
    program.upper[2] = 0.25;
    IpoptSolver ipopt;
    EXPECT_THAT(message_of([&] { (void)ipopt.solve(program, start); }), HasSubstr("lower[2]"));
    for (const auto method : all_methods) {
        EXPECT_THAT(message_of([&] { (void)solve_with_nlopt(method, program, start); }), HasSubstr("lower[2]"));
    }
    // COND3 from both sides fixes a class at zero before any program is made.
    int conflicts = 0;
    for (int period = 2; period <= 24; ++period) {
        for (int contact = 1; contact < period; ++contact) {
            const auto conditions = nsma::conditions(nsma::exact_kernel({6, period - contact, contact}), 1);
            const auto reduction = nsma::reduce(conditions);
            for (int column = 0; column < reduction.variables(); ++column) {
                EXPECT_NE(conditions.bound_of[static_cast<std::size_t>(column)], nsma::Conditions::Sign::zero);
            }
            conflicts += reduction.removed.sign_conflicts;
        }
    }
    EXPECT_GT(conflicts, 0);
}

TEST(FailureTable, Row17AnOptionTheLibraryDoesNotTake) {
    SolverOptions options;
    options.tolerance = -1;
    EXPECT_THAT(message_of([&] { IpoptSolver{options}; }), HasSubstr("tolerance: expected > 0, got -1"));
    options = {};
    options.max_iterations = -5;
    EXPECT_THAT(message_of([&] { IpoptSolver{options}; }), HasSubstr("max_iterations: expected >= 0, got -5"));
    options = {};
    options.time_limit = -1;
    EXPECT_THAT(message_of([&] { IpoptSolver{options}; }), HasSubstr("time_limit: expected > 0 s, got -1"));
}

TEST(FailureTable, Row18ActiveInequalities) {
    const auto item = textbook::linear_on_cap();
    const auto raw = IpoptSolver().solve(item.program, start);
    const auto polished = nsma::polish(item.program, raw.x);
    EXPECT_TRUE(polished.feasible);
    EXPECT_LE(item.program.violation(polished.x), 1e-12);                                  // of the polish
    EXPECT_NEAR(polished.multipliers.inequality[0], 4 - 3 * 0.5 / std::sqrt(0.75), 1e-9);  // derived at the case
    for (const double factor : {1.5, 4.0})
        expect_sound(solve({6, 23, 1}, 1, {.level = factor * 12.0 / 11.0, .reference = {}}));
}

TEST(FailureTable, Row19MultipliersOfFixedVariables) {
    // min 3x + 4y on the unit sphere with z = 0.6 fixed: (x, y) = -0.8 (3, 4)/5, mu = 5/(2 0.8), and
    // stationarity in z, 2 mu z + z_upper - z_lower = 0, wants z_lower - z_upper = 3.75.
    auto program = textbook::linear_on_sphere().program;
    program.lower[2] = program.upper[2] = 0.6;
    const Vector3d optimum(-0.48, -0.64, 0.6);
    for (const auto& outcome : {IpoptSolver().solve(program, Vector3d(0.8, 0, 0.6)),
                                solve_with_nlopt(NloptMethod::slsqp, program, Vector3d(0.8, 0, 0.6))}) {
        ASSERT_LT((outcome.x - optimum).norm(), 1e-3) << outcome.status;
        const auto polished = nsma::polish(program, outcome.x);
        ASSERT_TRUE(polished.feasible && polished.stationary) << outcome.status;
        EXPECT_LT((polished.x - optimum).norm(), 1e-8);
        EXPECT_NEAR(polished.multipliers.sphere, 3.125, 1e-7);
        EXPECT_NEAR(polished.multipliers.lower[2] - polished.multipliers.upper[2], 3.75, 1e-7);
        EXPECT_LE(polished.multipliers.residual, 1e-9);
    }
}

TEST(FailureTable, Row20SquareProblem) {
    // x = 0.6, y = 0 on the unit sphere: two points and no freedom; any objective is stationary.
    auto program = textbook::unit_sphere({1, 2, 3});
    Eigen::MatrixXd planes = Eigen::MatrixXd::Zero(2, 3);
    planes(0, 0) = planes(1, 1) = 1;
    program.equalities = planes.sparseView();
    program.equality_values = Eigen::Vector2d(0.6, 0);
    const auto outcome = IpoptSolver().solve(program, Vector3d(0.6, 0, -0.8));
    EXPECT_LT(program.violation(outcome.x), 1e-6) << outcome.status;
    const auto polished = nsma::polish(program, Vector3d(0.6, 0, -0.8));
    EXPECT_TRUE(polished.feasible && polished.stationary);
    EXPECT_LE(polished.multipliers.residual, 1e-12);
    // 3 + 2 mu z = 0, 1 + nu_0 + 2 mu x = 0, 2 + nu_1 = 0 at z = -0.8.
    EXPECT_NEAR(polished.multipliers.sphere, 1.875, 1e-12);
    EXPECT_NEAR(polished.multipliers.equality[0], -1 - 2.25, 1e-12);
    EXPECT_NEAR(polished.multipliers.equality[1], -2, 1e-12);
}

TEST(Solvers, ATimeLimitHoldsForEveryMethod) {
    SolverOptions options;
    options.time_limit = 1e-9;
    const auto item = textbook::trust_region();
    for (const auto method : all_methods) {
        const auto outcome = solve_with_nlopt(method, item.program, start, options);
        EXPECT_EQ(outcome.status, "MAXTIME_REACHED");
        EXPECT_LE(outcome.iterations, 5);
        EXPECT_TRUE(outcome.x.allFinite());
    }
    options.time_limit = 0;
    EXPECT_THROW((void)solve_with_nlopt(NloptMethod::slsqp, item.program, start, options), std::invalid_argument);
    options.time_limit = std::numeric_limits<double>::infinity();  // no limit
    EXPECT_NE(solve_with_nlopt(NloptMethod::slsqp, item.program, start, options).status, "MAXTIME_REACHED");
}

}  // namespace
