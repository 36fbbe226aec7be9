#include "nsma/orbit/sieve.hpp"

#include <cstdlib>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "gap_sign.hpp"
#include "index.hpp"
#include "nsma/wave/mesh.hpp"

namespace nsma {
Sieve::Sieve(int cells, int gap_sign) : cells_(cells), gap_sign_(gap_sign) {
    validate(Mesh{cells});
    validate_gap_sign(gap_sign);
}

void Sieve::prepare(int period_steps) {
    period_ = period_steps;
    classes_ = std::gcd(2 * cells_, period_steps);
    places_ = period_steps / classes_;
    step_ = (2 * cells_ / classes_) % places_;
    of_free_.assign(index(places_) + 1, Place{});
    sign_.resize(index(places_));
    // Decided by a walk, once it is asked for.
    const auto decide = [this](int contact_places) {
        const int free_places = places_ - contact_places;
        if (free_places % 2 == 0) of_free_[index(free_places)].walked = false;
    };
    if (places_ % 2 == 0) {
        // No contact place: the signs alternate, x_0 = -P_m.
        of_free_[index(places_)] = {gap_sign_ > 0 ? Finding::admissible : Finding::wrong_side, true, 1};
    }
    decide(1);
    if (places_ == 1) return;
    // Returns to the first h places: after `a` steps to the right by da, after `b` to the left
    // by db; h = da + db has no third return.
    int a = 1, b = 1;
    int da = step_, db = places_ - step_;
    while (da + db > 1 && da > 0 && db > 0) {
        if (a % 2 == 1 && b % 2 == 1) decide(da + db);
        if (da >= db) {
            da -= db;
            a += b;
        } else {
            db -= da;
            b += a;
        }
    }
}

Sieve::Place Sieve::walk(int free_places) {
    int sign = 1;
    for (int step = 0, place = 0; step < places_; ++step) {
        sign_[index(place)] = static_cast<std::int8_t>(sign);
        if (place < free_places) sign = -sign;
        place += step_;
        if (place >= places_) place -= places_;
    }
    // The sign that COND3 gives the amplitudes: that of any contact place.
    const std::int8_t side = sign_[index(free_places)];
    const int window = 2 * cells_ / classes_;
    const auto sum_to = [this](int end) {
        return std::accumulate(sign_.begin(), sign_.begin() + end, std::int64_t{0});
    };
    const std::int64_t weight = -side * (window / places_ * sum_to(places_) + sum_to(window % places_));
    if (gap_sign_ == 0 ? weight != 0 : gap_sign_ * weight <= 0) return {Finding::wrong_side, true, 0};
    int height = 0;
    for (int place = 0; place < free_places; ++place) {
        height += side * sign_[index(place)];
        if (height > 0) return {Finding::penetrates, true, 0};
    }
    return {Finding::admissible, true, static_cast<std::int32_t>(std::abs(weight))};
}

Sieved Sieve::operator()(int free_steps, int contact_steps) {
    if (free_steps < 1 || contact_steps < 1 || free_steps > max_period_steps - contact_steps) {
        throw std::invalid_argument(
            fmt::format("pattern: expected free and contact steps >= 1 and at most {} in all, got {} and {}",
                        max_period_steps, free_steps, contact_steps));
    }
    if (free_steps + contact_steps != period_) prepare(free_steps + contact_steps);
    const int q = free_steps / classes_;
    const int s = free_steps % classes_;
    Sieved result;
    result.kernel_dimension = q % 2 == 0 ? classes_ - s : s;
    if (result.kernel_dimension == 0) return result;
    const int free_places = q % 2 == 0 ? q : q + 1;  // of the live classes
    Place& place = of_free_[index(free_places)];
    if (!place.walked) place = walk(free_places);
    result.finding = place.finding;
    if (place.finding != Finding::admissible) return result;
    if (gap_sign_ == 0) {
        result.unbounded = true;
        return result;
    }
    const double m = result.kernel_dimension;
    const double unit = 4.0 * cells_ * cells_;
    const double scale = static_cast<double>(classes_) * place.weight * place.weight;
    result.energy_least = unit / (scale * m);
    // A simplex: one class alone; otherwise as many steps of size one as their parity allows.
    const bool simplex = free_places < places_;
    const double ones = simplex ? 1.0 : result.kernel_dimension % 2 == 1 ? m : m - 1;
    result.energy_greatest = unit * ones / scale;
    return result;
}

}  // namespace nsma
