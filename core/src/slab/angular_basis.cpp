#include "slab/angular_basis.h"

#include <cmath>
#include <utility>

namespace skinglow::detail {

AngularBasis::AngularBasis(Eigen::VectorXd cosine_, const Eigen::VectorXd& weight)
    : cosine(std::move(cosine_)), weight_sum(weight.sum()) {
    const Eigen::Index n = cosine.size();
    even.resize(n, n);
    odd.resize(n, n);
    recurrence.resize(2 * n - 1);
    even.col(0) = (weight / weight_sum).cwiseSqrt();
    Eigen::VectorXd next(n);
    Eigen::VectorXd overlap(n);
    // The three-term recurrence alone loses orthogonality at high degree: each polynomial is orthogonalized once
    // more against all before it of its own parity ("twice is enough", Giraud et al. 2005, Numer Math 101:87).
    for (Eigen::Index degree = 1; degree < 2 * n; ++degree) {
        const Eigen::Index i = degree / 2;
        const bool is_odd = degree % 2 == 1;
        Eigen::MatrixXd& own = is_odd ? odd : even;
        const Eigen::MatrixXd& other = is_odd ? even : odd;
        next = cosine.cwiseProduct(other.col(is_odd ? i : i - 1));
        if (i > 0) {
            next -= recurrence[degree - 2] * own.col(i - 1);
            overlap.head(i).noalias() = own.leftCols(i).transpose() * next;
            next.noalias() -= own.leftCols(i) * overlap.head(i);
        }
        const double norm = next.norm();
        recurrence[degree - 1] = norm;
        own.col(i) = next / norm;
    }
}

}  // namespace skinglow::detail
