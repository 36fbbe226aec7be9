#pragma once

#include <string>
#include <vector>

#include "nsma/orbit/conditions.hpp"
#include "nsma/check/certificate.hpp"

namespace nsma {

/// Why a certificate does not hold.
struct Invalid {
    std::string reason;
};
[[noreturn]] void invalid(std::string reason);
[[nodiscard]] std::string column_name(int column);

/// Fractions over one denominator > 0.
struct Fractions {
    std::vector<Integer> numerators;
    Integer denominator = 1;
};

/// The least common multiple of the two. Throws Invalid where it is longer than honest certificates need: sums over it
/// would be as long, and a small forged line take minutes.
[[nodiscard]] Integer common_multiple(const Integer& a, const Integer& b);

/// What every part of a certificate is checked against: the pattern's signs and COND1-3, as integers, and exact sums of
/// them. Its functions throw Invalid, and Interrupted.
struct CertificateTerms {
    using Sign = Conditions::Sign;

    /// Throws Invalid where the certificate asks for more work than any honest one.
    explicit CertificateTerms(const Certificate& of);

    /// Whether COND3 allows a value of this sign (-1, 0, 1) in a column.
    [[nodiscard]] bool allows(std::size_t column, int sign) const;
    [[nodiscard]] Fractions dense(const RationalVector& sparse, const char* what) const;
    /// sum_n y_n a_n over the columns: step k carries the sum of y_n over n > k.
    [[nodiscard]] Fractions combine_rows(const RationalVector& rows) const;
    /// Proved upper bound of the form over the admissible set.
    [[nodiscard]] Rational verified(const FormBound& bound) const;

    const Certificate& certificate;
    Kernel kernel;
    std::vector<Sign> signs;  ///< of COND3, by column
    std::size_t dimension;
    std::vector<int> contact;  ///< w, COND2's row
    Rational factor;           ///< E/E_unit = factor |beta|^2
};

/// The upper bound on |beta|^2 that the certificate's chain proves. Throws Invalid.
[[nodiscard]] Rational proved_square(const CertificateTerms& terms);

}  // namespace nsma
