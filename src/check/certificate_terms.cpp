#include "certificate_terms.hpp"

#include <iterator>
#include <utility>

#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

// Honest denominators are products of a few numbers below 2^40.
constexpr unsigned common_bits = 1024;
// Steps walked and columns compared over all forms of a certificate: some ten seconds. A chain of 500 columns, ten
// megabytes of text, has three millions.
constexpr double most_work = 1e8;

}  // namespace

void invalid(std::string reason) { throw Invalid{std::move(reason)}; }

std::string column_name(int column) { return "column " + std::to_string(column); }

Integer common_multiple(const Integer& a, const Integer& b) {
    Integer result = lcm(a, b);
    if (msb(result) >= common_bits) {
        invalid("fractions: expected a common denominator below 2^" + std::to_string(common_bits) + ", got one above");
    }
    return result;
}

CertificateTerms::CertificateTerms(const Certificate& of)
    : certificate(of),
      kernel(exact_kernel(of.pattern)),
      signs(conditions(kernel, of.gap_sign).bound_of),
      dimension(static_cast<std::size_t>(kernel.dimension())),
      factor(Integer(4) * of.pattern.cells * of.pattern.cells, of.pattern.class_count()) {
    const auto forms = static_cast<double>(of.rest.size() + of.greatest_proof.chain_bounds.size());
    const double work = forms * (static_cast<double>(of.pattern.free_steps) + static_cast<double>(dimension));
    if (work > most_work) {
        invalid("size: expected at most " + std::to_string(static_cast<long>(most_work)) +
                " steps and columns over all forms, got " + std::to_string(static_cast<long>(work)));
    }
    const Eigen::VectorXi row = contact_row(kernel);
    contact.assign(row.data(), row.data() + row.size());
}

bool CertificateTerms::allows(std::size_t column, int sign) const {
    if (sign == 0) return true;
    const Sign allowed = signs[column];
    return allowed == Sign::free || allowed == (sign > 0 ? Sign::nonnegative : Sign::nonpositive);
}

Fractions CertificateTerms::dense(const RationalVector& sparse, const char* what) const {
    Fractions result{std::vector<Integer>(dimension)};
    int last = -1;
    for (const auto& [column, value] : sparse) {
        if (column <= last || column >= static_cast<int>(dimension)) {
            invalid(std::string(what) + ": expected increasing columns below " + std::to_string(dimension) + ", got " +
                    std::to_string(column));
        }
        last = column;
        result.denominator = common_multiple(result.denominator, denominator(value));
    }
    for (const auto& [column, value] : sparse) {
        result.numerators[static_cast<std::size_t>(column)] =
            numerator(value) * (result.denominator / denominator(value));
    }
    return result;
}

Fractions CertificateTerms::combine_rows(const RationalVector& rows) const {
    Fractions result{std::vector<Integer>(dimension)};
    int last = 0;
    for (const auto& [n, y] : rows) {
        if (n <= last || n >= certificate.pattern.free_steps) {
            invalid("rows: expected increasing steps in 1.." + std::to_string(certificate.pattern.free_steps - 1) +
                    ", got " + std::to_string(n));
        }
        if (y < 0) invalid("COND1 row " + std::to_string(n) + ": multiplier is negative");
        last = n;
        result.denominator = common_multiple(result.denominator, denominator(y));
    }
    Integer weight;
    auto row = rows.rbegin();
    for (int k = last - 1; k >= 0; --k) {
        for (; row != rows.rend() && row->first > k; ++row)
            weight += numerator(row->second) * (result.denominator / denominator(row->second));
        const int column = kernel.column(k);
        if (column < 0) continue;
        Integer& sum = result.numerators[static_cast<std::size_t>(column)];
        if (kernel.sign[static_cast<std::size_t>(k)] > 0)
            sum += weight;
        else
            sum -= weight;
    }
    return result;
}

Rational CertificateTerms::verified(const FormBound& bound) const {
    stop_point();
    const Fractions form = dense(bound.form, "form");
    const Fractions rows = combine_rows(bound.proof.rows);
    const Rational& nu = bound.proof.contact;
    const Integer common = common_multiple(common_multiple(form.denominator, rows.denominator), denominator(nu));
    const Integer of_form = common / form.denominator;
    const Integer of_rows = common / rows.denominator;
    const Integer of_contact = numerator(nu) * (common / denominator(nu));
    for (std::size_t c = 0; c < dimension; ++c) {
        const Integer rest = form.numerators[c] * of_form - rows.numerators[c] * of_rows - of_contact * contact[c];
        // No allowed value may make the rest positive.
        if (rest != 0 && allows(c, rest.sign()))
            invalid("bound: multipliers do not dominate " + column_name(static_cast<int>(c)));
    }
    return nu * certificate.gap_sign;
}

}  // namespace nsma
