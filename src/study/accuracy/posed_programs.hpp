#pragma once

#include <string>
#include <vector>

#include "program_methods.hpp"

namespace nsma {

/// The same program, posed as a careless caller would.
struct PosedProgram {
    std::string what;
    Program program;
};

/// Objective and linear rows in units 10^k of their own; the sphere keeps its unit radius.
[[nodiscard]] std::vector<PosedProgram> scaled_programs(const Program& program, bool quick);

/// Rows that presolve removes, put back: COND2 at each contact step, COND3 as rows instead of
/// bounds, COND1 at each step of the free flight, and all of them.
[[nodiscard]] std::vector<PosedProgram> redundant_programs(const ProgramCase& on);

}  // namespace nsma
