#include "certificate_terms.hpp"

#include <numeric>
#include <optional>

namespace nsma {
namespace {

constexpr unsigned most_bits = 40;

std::int64_t small(const Integer& value) {
    if (value != 0 && msb(abs(value)) >= most_bits)
        invalid("numbers: expected all over a common denominator below 2^" + std::to_string(most_bits));
    return value.convert_to<std::int64_t>();
}

std::int64_t small(Whole value) {
    constexpr Whole limit = Whole{1} << most_bits;
    if (value >= limit || value <= -limit)
        invalid("numbers: expected all over a common denominator below 2^" + std::to_string(most_bits));
    return static_cast<std::int64_t>(value);
}

// The numerators of a sparse vector over a common denominator.
struct Numerators {
    std::vector<std::int64_t> values;
    std::int64_t denominator = 1;

    explicit Numerators(const RationalVector& sparse) {
        for (const auto& entry : sparse) {
            const std::int64_t own = small(denominator_of(entry.second));
            if (own != denominator) denominator = small(Whole{denominator} / std::gcd(denominator, own) * own);
        }
        values.reserve(sparse.size());
        for (const auto& entry : sparse) {
            const std::int64_t own = small(denominator_of(entry.second));
            values.push_back(small(Whole{small(numerator(entry.second))} * (denominator / own)));
        }
    }

private:
    static Integer denominator_of(const Rational& value) { return boost::multiprecision::denominator(value); }
};

}  // namespace

void invalid(std::string reason) { throw Invalid{std::move(reason)}; }

std::string column_name(int column) { return "column " + std::to_string(column); }

CertificateTerms::CertificateTerms(const Certificate& of)
    : certificate(of),
      kernel(exact_kernel(of.pattern)),
      signs(conditions(kernel, of.gap_sign).bound_of),
      dimension(static_cast<std::size_t>(kernel.dimension())),
      factor(Integer(4) * of.pattern.cells * of.pattern.cells, of.pattern.class_count()) {
    const Eigen::VectorXi row = contact_row(kernel);
    contact.assign(row.data(), row.data() + row.size());
}

bool CertificateTerms::allows(std::size_t column, int sign) const {
    if (sign == 0) return true;
    const Sign allowed = signs[column];
    return allowed == Sign::free || allowed == (sign > 0 ? Sign::nonnegative : Sign::nonpositive);
}

Fractions CertificateTerms::dense(const RationalVector& sparse, const char* what) const {
    int last = -1;
    for (const auto& entry : sparse) {
        if (entry.first <= last || entry.first >= static_cast<int>(dimension)) {
            invalid(std::string(what) + ": expected increasing columns below " + std::to_string(dimension) + ", got " +
                    std::to_string(entry.first));
        }
        last = entry.first;
    }
    const Numerators numerators(sparse);
    Fractions result{std::vector<std::int64_t>(dimension), numerators.denominator};
    for (std::size_t i = 0; i < sparse.size(); ++i)
        result.numerators[static_cast<std::size_t>(sparse[i].first)] = numerators.values[i];
    return result;
}

Fractions CertificateTerms::without_rows(const RationalVector& rows) const {
    int last = 0;
    for (const auto& [n, y] : rows) {
        if (n <= last || n >= certificate.pattern.free_steps) {
            invalid("rows: expected increasing steps in 1.." + std::to_string(certificate.pattern.free_steps - 1) +
                    ", got " + std::to_string(n));
        }
        if (y < 0) invalid("COND1 row " + std::to_string(n) + ": multiplier is negative");
        last = n;
    }
    const Numerators multipliers(rows);
    std::vector<Whole> sums(dimension);
    Whole weight = 0;
    std::size_t row = rows.size();
    for (int k = last - 1; k >= 0; --k) {
        for (; row > 0 && rows[row - 1].first > k; --row) weight += multipliers.values[row - 1];
        const int column = kernel.column(k);
        if (column >= 0) sums[static_cast<std::size_t>(column)] += kernel.sign[static_cast<std::size_t>(k)] * weight;
    }
    Fractions result{std::vector<std::int64_t>(dimension), multipliers.denominator};
    for (std::size_t c = 0; c < dimension; ++c)
        result.numerators[c] = small(Whole{certificate.gap_sign} * contact[c] * result.denominator - sums[c]);
    return result;
}

void check_cone(const CertificateTerms& terms, const Fractions& beta, const char* what) {
    for (std::size_t c = 0; c < terms.dimension; ++c) {
        const std::int64_t value = beta.numerators[c];
        if (!terms.allows(c, value > 0 ? 1 : value < 0 ? -1 : 0))
            invalid(std::string(what) + ": COND3 fails at " + column_name(static_cast<int>(c)));
    }
    Whole sum = 0;
    terms.kernel.for_each_live(0, terms.certificate.pattern.free_steps, [&](int k, std::size_t column, int sign) {
        sum += Whole{beta.numerators[column]} * sign;
        if (sum > 0) invalid(std::string(what) + ": COND1 row " + std::to_string(k + 1) + " fails");
    });
    if (sum != 0) invalid(std::string(what) + ": the tip does not return to the wall");
}

Whole contact_value(const CertificateTerms& terms, const Fractions& beta) {
    Whole sum = 0;
    for (std::size_t c = 0; c < terms.dimension; ++c) sum += Whole{beta.numerators[c]} * terms.contact[c];
    return sum;
}

Rational square(const Fractions& beta) {
    Whole sum = 0;
    for (const std::int64_t value : beta.numerators) sum += Whole{value} * value;
    Rational result(sum);
    result /= beta.denominator;
    result /= beta.denominator;
    return result;
}

}  // namespace nsma
