#include "nsma/search/answer.hpp"

namespace nsma {

std::string_view name(Verdict verdict) {
    switch (verdict) {
        case Verdict::trivial: return "trivial";
        case Verdict::inadmissible: return "inadmissible";
        case Verdict::below: return "below";
        case Verdict::above: return "above";
        case Verdict::undecided: return "undecided";
        case Verdict::admissible: return "admissible";
        case Verdict::failed: return "failed";
    }
    return "failed";
}

std::string_view name(Agreement agreement) {
    switch (agreement) {
        case Agreement::not_needed: return "not_needed";
        case Agreement::agree: return "agree";
        case Agreement::different_optimum: return "different_optimum";
        case Agreement::one_failed: return "one_failed";
        case Agreement::both_failed: return "both_failed";
        case Agreement::single: return "single";
    }
    return "both_failed";
}

}  // namespace nsma
