#include "nsma/orbit/pattern_kind.hpp"

namespace nsma {

std::string_view name(PatternKind kind) {
    switch (kind) {
        case PatternKind::contact: return "contact";
        case PatternKind::free: return "free";
        case PatternKind::stuck: break;
    }
    return "stuck";
}

std::optional<PatternKind> pattern_kind(const Pattern& pattern) {
    if (kernel_dimension(pattern) == 0) return std::nullopt;
    const int classes = pattern.class_count();
    const int rounds = pattern.free_steps / classes;
    const int free_places = rounds + rounds % 2;  // of the live classes: even
    if (free_places == 0) return PatternKind::stuck;
    return free_places == pattern.period_steps() / classes ? PatternKind::free : PatternKind::contact;
}

}  // namespace nsma
