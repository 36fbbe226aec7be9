#include "certificate_terms.hpp"

#include <iterator>
#include <utility>

namespace nsma {

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

bool CertificateTerms::allows(std::size_t column, const Rational& value) const {
    if (value == 0) return true;
    const Sign sign = signs[column];
    return sign == Sign::free || sign == (value > 0 ? Sign::nonnegative : Sign::nonpositive);
}

CertificateTerms::Dense CertificateTerms::dense(const RationalVector& sparse, const char* what) const {
    Dense result(dimension);
    int last = -1;
    for (const auto& [column, value] : sparse) {
        if (column <= last || column >= static_cast<int>(dimension)) {
            invalid(std::string(what) + ": expected increasing columns below " + std::to_string(dimension) + ", got " +
                    std::to_string(column));
        }
        last = column;
        result[static_cast<std::size_t>(column)] = value;
    }
    return result;
}

CertificateTerms::Dense CertificateTerms::combine_rows(const RationalVector& rows) const {
    int last = 0;
    for (const auto& [n, y] : rows) {
        if (n <= last || n >= certificate.pattern.free_steps) {
            invalid("rows: expected increasing steps in 1.." + std::to_string(certificate.pattern.free_steps - 1) +
                    ", got " + std::to_string(n));
        }
        if (y < 0) invalid("COND1 row " + std::to_string(n) + ": multiplier is negative");
        last = n;
    }
    Dense result(dimension);
    Rational weight;
    int end = rows.empty() ? 0 : rows.back().first;
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
        const int begin = std::next(row) == rows.rend() ? 0 : std::next(row)->first;
        weight += row->second;
        // Steps begin..end-1 all carry the same weight: count their signs first.
        std::vector<int> count(dimension, 0);
        for (int k = begin; k < end; ++k) {
            const int column = kernel.column(k);
            if (column >= 0) count[static_cast<std::size_t>(column)] += kernel.sign[static_cast<std::size_t>(k)];
        }
        for (std::size_t c = 0; c < dimension; ++c) {
            if (count[c] != 0) result[c] += weight * count[c];
        }
        end = begin;
    }
    return result;
}

Rational CertificateTerms::verified(const FormBound& bound) const {
    const Dense form = dense(bound.form, "form");
    const Dense rows = combine_rows(bound.proof.rows);
    for (std::size_t c = 0; c < dimension; ++c) {
        const Rational rest = form[c] - rows[c] - bound.proof.contact * contact[c];
        // No allowed value may make the rest positive.
        if (allows(c, rest) && rest != 0)
            invalid("bound: multipliers do not dominate " + column_name(static_cast<int>(c)));
    }
    return bound.proof.contact * certificate.gap_sign;
}

}  // namespace nsma
