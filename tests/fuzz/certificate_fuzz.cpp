// Any bytes as a certificate: refused, rejected, or true. The truth is that of the sieve, which shares nothing with the
// checker but the pattern.
#include <cstdint>

#include "fuzz.hpp"

#include "nsma/orbit/sieve.hpp"
#include "nsma/report/input_error.hpp"
#include "report/certificate_file.hpp"

namespace {

using nsma::Certificate;
using nsma::Finding;

constexpr int judged_steps = 20'000;  // so that most runs take microseconds

void expect_true(const Certificate& said) {
    nsma::Sieve sieve(said.pattern.cells, said.gap_sign);
    const nsma::Sieved found = sieve(said.pattern.free_steps, said.pattern.contact_steps);
    switch (said.claim) {
        case Certificate::Claim::trivial: fuzz::expect(found.finding == Finding::trivial, "trivial"); return;
        case Certificate::Claim::empty:
            fuzz::expect(found.finding != Finding::trivial && found.finding != Finding::admissible, "empty");
            return;
        case Certificate::Claim::nonempty: break;
    }
    fuzz::expect(found.finding == Finding::admissible, "nonempty");
    if (said.gap_sign == 0) return;
    constexpr double rounding = 1e-12;  // of quotients of integers
    const double least = nsma::to_double(*said.energy_least);
    fuzz::expect(std::abs(least / found.energy_least - 1) < rounding, "least energy");
    if (said.energy_attained)
        fuzz::expect(nsma::to_double(*said.energy_attained) <= found.energy_greatest * (1 + rounding),
                     "energy attained");
    if (said.energy_bound)
        fuzz::expect(nsma::to_double(*said.energy_bound) >= found.energy_greatest * (1 - rounding), "energy bound");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Certificate said = nsma::parse_certificate({reinterpret_cast<const char*>(data), size}, "input");
        if (said.pattern.cells > judged_steps || said.pattern.free_steps > judged_steps ||
            said.pattern.contact_steps > judged_steps)
            return 0;
        const nsma::CheckResult result = nsma::check(said);
        if (result.valid)
            expect_true(said);
        else
            fuzz::expect_one_line(result.reason);
    } catch (const nsma::InputError& error) {
        fuzz::expect_one_line(error.what());
    }
    return 0;
}
