#pragma once

#include <cstdint>
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

/// Sums of squares of numbers below 2^40 over at most 2^24 columns or steps fit, with room to spare.
__extension__ using Whole = __int128;

/// Fractions over one denominator > 0, all numbers below 2^40. Honest ones are below 2^24.
struct Fractions {
    std::vector<std::int64_t> numerators;
    std::int64_t denominator = 1;
};

/// What every part of a certificate is checked against: the pattern's signs and COND1-3, as integers, and exact sums of
/// them. Its functions throw Invalid; each is O(n_T).
struct CertificateTerms {
    using Sign = Conditions::Sign;

    explicit CertificateTerms(const Certificate& of);

    /// Whether COND3 allows a value of this sign (-1, 0, 1) in a column.
    [[nodiscard]] bool allows(std::size_t column, int sign) const;
    [[nodiscard]] Fractions dense(const RationalVector& sparse, const char* what) const;
    /// delta w - sum_n y_n a_n over the columns: step k carries the sum of y_n over n > k.
    [[nodiscard]] Fractions without_rows(const RationalVector& rows) const;

    const Certificate& certificate;
    Kernel kernel;
    std::vector<Sign> signs;  ///< of COND3, by column
    std::size_t dimension;
    std::vector<int> contact;  ///< w, COND2's row
    Rational factor;           ///< E/E_unit = factor |beta|^2
};

/// Whether COND2 and COND3 alone bound every column: w_c beta_c/delta >= 0 for all that may differ from zero, or of a
/// closed gap w_c beta_c of one sign, so that all are zero.
[[nodiscard]] bool is_simplex(const CertificateTerms& terms);

/// Throws Invalid unless COND1 bounds the partial sums of the certificate's chain from both sides.
void expect_chain(const CertificateTerms& terms);

/// The upper bound on |beta|^2 that follows of a simplex, or of the certificate's chain. Throws Invalid where neither
/// holds.
[[nodiscard]] Rational proved_square(const CertificateTerms& terms);

/// What the certificate's optimum proves. Throws Invalid where that is nothing.
[[nodiscard]] OptimumFacts proved_optimum(const CertificateTerms& terms, const Optimum& optimum);

/// COND1 and COND3 of a point or direction (a cone); COND2 is the caller's.
void check_cone(const CertificateTerms& terms, const Fractions& beta, const char* what);
/// w . beta over the denominator of beta.
[[nodiscard]] Whole contact_value(const CertificateTerms& terms, const Fractions& beta);
/// |beta|^2.
[[nodiscard]] Rational square(const Fractions& beta);

}  // namespace nsma
