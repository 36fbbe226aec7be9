#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// What kind of motion the admissible orbits of a pattern are.
enum class PatternKind : std::uint8_t {
    contact,  ///< some orbit presses against the wall and leaves it: a nonsmooth mode
    free,     ///< no orbit presses: a free vibration that at most grazes the wall
    stuck     ///< no orbit leaves the wall: the bar vibrates with its end held
};
/// Every kind, in the order of its values.
inline constexpr std::array pattern_kinds{PatternKind::contact, PatternKind::free, PatternKind::stuck};
[[nodiscard]] std::string_view name(PatternKind kind);  ///< "contact", "free", "stuck"

/// The kind, from the kernel alone, O(log N); absent for a trivial kernel. With g = gcd(2N, n_T) the live classes all
/// have the same even number f of free steps among their n_T/g steps. f = n_T/g: no contact step carries a wave, so
/// there is no force. f = 0: no step of the flight carries a wave, so the tip does not move. Otherwise every live class
/// presses in some step and moves the tip in another, so that every admissible orbit but rest does both. No condition
/// is needed to decide.
[[nodiscard]] std::optional<PatternKind> pattern_kind(const Pattern& pattern);

}  // namespace nsma
