#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "chart.hpp"
#include "nsma/wave/bar.hpp"

namespace nsma {

/// Fields at times (rows) and places from the held end (columns), each in the middle of its share of time and bar.
struct FieldSamples {
    Eigen::MatrixXd stress;                       ///< [Pa]
    Eigen::MatrixXd velocity;                     ///< [m/s]
    double duration = 0;                          ///< [s]
    std::vector<std::array<double, 2>> contacts;  ///< from, to [s]
};

/// Stress and velocity over bar and time, beside each other.
[[nodiscard]] Chart field_chart(const Bar& bar, const FieldSamples& fields, const std::string& name,
                                const std::string& scene, const std::string& title);

}  // namespace nsma
