#pragma once

#include <optional>

#include <Eigen/Core>

namespace nsma {

/// Zero, surely not zero, or neither: what lies between the two bounds decides nothing.
enum class Magnitude { zero, positive, unclear };

struct MagnitudeBounds {
    double zero = 1e-9;      ///< at most this: zero
    double positive = 1e-6;  ///< at least this: positive

    [[nodiscard]] Magnitude operator()(double value) const {
        if (value <= zero) return Magnitude::zero;
        return value >= positive ? Magnitude::positive : Magnitude::unclear;
    }
};

/// Multipliers of a point, the polyhedron
///   { (y, w): gradient + normals' y + smooth' w = 0, y >= 0 }.
/// w is eliminated by an orthonormal basis of the space orthogonal to `smooth`, so that linear
/// programs over the set have unknowns with a sign only. Its support function is the derivative
/// of an optimal value along right-hand sides.
class MultiplierSet {
public:
    enum class Status { empty, one, many, unclear };

    /// `normals` k x n and `smooth` q x n, rows of norm about one; `gradient` size n. Magnitudes
    /// of residual and multipliers are relative to 1 + |gradient|.
    MultiplierSet(Eigen::MatrixXd normals, Eigen::MatrixXd smooth, Eigen::VectorXd gradient,
                  const MagnitudeBounds& magnitude);

    [[nodiscard]] Status status() const { return status_; }
    [[nodiscard]] const Eigen::VectorXd& normal() const { return y_; }  ///< y of one element, size k
    [[nodiscard]] Eigen::VectorXd smooth() const;                       ///< its w, size q
    [[nodiscard]] double residual() const;                              ///< of the element, relative
    /// Of -gradient on { d: normals d <= 0, smooth d = 0 }: not zero if and only if the set is empty.
    [[nodiscard]] const Eigen::VectorXd& projection() const { return projection_; }

    struct Greatest {
        enum class Status { finite, infinite, unclear } status = Status::unclear;
        double value = 0;
        Eigen::VectorXd y;  ///< an element that attains it
    };
    /// Greatest -(y . a + w . b) over the set, `smooth` of full row rank; unclear unless the status
    /// is `one` or `many`. The linear program's answer is accepted only with its dual.
    [[nodiscard]] Greatest greatest(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
    /// Greatest of each y_i over the set, up to 1 + |gradient|; negative where unclear.
    [[nodiscard]] Eigen::VectorXd greatest_normals() const;

private:
    [[nodiscard]] std::optional<Eigen::VectorXd> certified_least(const Eigen::VectorXd& cost) const;
    [[nodiscard]] Greatest least_over_set(const Eigen::VectorXd& cost) const;

    Eigen::MatrixXd normals_, smooth_;
    Eigen::VectorXd gradient_;
    MagnitudeBounds magnitude_;
    double scale_ = 1;
    Eigen::MatrixXd system_;  // independent rows of basis' normals' y = -basis' gradient
    Eigen::VectorXd target_;
    Eigen::VectorXd y_, projection_;
    Status status_ = Status::unclear;
};

/// Orthonormal basis of the space orthogonal to the rows; `rank_clear` is false when a singular
/// value is neither zero nor positive.
[[nodiscard]] Eigen::MatrixXd orthogonal_space(const Eigen::MatrixXd& rows, Eigen::Index n,
                                               const MagnitudeBounds& magnitude, bool& rank_clear);

}  // namespace nsma
