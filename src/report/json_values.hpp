#pragma once

#include <string>
#include <variant>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "one_line.hpp"
#include "study/sweep/record_fields.hpp"

namespace nsma {

/// Values of records as JSON; NaN and infinity become null when written, texts one line, and no zero is negative.
[[nodiscard]] inline nlohmann::ordered_json value_json(std::monostate) { return nullptr; }
[[nodiscard]] inline nlohmann::ordered_json value_json(bool value) { return value; }
[[nodiscard]] inline nlohmann::ordered_json value_json(std::int64_t value) { return value; }
[[nodiscard]] inline nlohmann::ordered_json value_json(double value) { return value + 0.0; }
[[nodiscard]] inline nlohmann::ordered_json value_json(const std::string& text) { return one_line(text); }
[[nodiscard]] inline nlohmann::ordered_json value_json(const FieldValue& value) {
    return std::visit([](const auto& held) { return value_json(held); }, value);
}
[[nodiscard]] inline nlohmann::ordered_json value_json(const Eigen::VectorXd& values) {
    auto list = nlohmann::ordered_json::array();
    for (const double value : values) list.push_back(value_json(value));
    return list;
}

}  // namespace nsma
