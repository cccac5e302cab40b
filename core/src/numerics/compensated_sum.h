#pragma once

#include <cmath>
#include <glm/vec3.hpp>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Sum that carries the rounding error of each addition along (A. Neumaier, ZAMM 54:39, 1974), so that ten
/// thousand light weights spread over twelve decades give the same total, to the last bit or two, in whatever
/// order they come.
class CompensatedSum {
  public:
    void add(double term) {
        const double sum = sum_ + term;
        // The larger of the two keeps its digits in the sum; what the smaller one lost is recovered exactly.
        lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
        sum_ = sum;
    }
    /// An overflowed sum is inf and its lost part NaN: then the sum alone is the answer.
    double total() const { return std::isfinite(lost_) ? sum_ + lost_ : sum_; }

  private:
    double sum_ = 0;
    double lost_ = 0;
};

/// One compensated sum for each of R, G, B.
class CompensatedSumRgb {
  public:
    void add(const glm::dvec3& term) {
        for (int i = 0; i < 3; ++i) channel_[i].add(term[i]);
    }
    glm::dvec3 total() const { return {channel_[0].total(), channel_[1].total(), channel_[2].total()}; }

  private:
    CompensatedSum channel_[3];
};

}  // namespace skinglow::detail
