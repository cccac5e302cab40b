#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/compensated_sum.h"
#include "rig/light_tree.h"

namespace skinglow {
namespace {

struct Candidate {
    double key;  ///< largest channel of the bound
    std::int64_t node;
    glm::dvec3 bound;
    bool operator<(const Candidate& other) const { return key < other.key; }
};

/// Nodes that are culled, the largest bound on top, and the sum of their bounds.
class Culled {
  public:
    void add(std::int64_t node, const glm::dvec3& bound) {
        candidates_.push_back({max_abs(bound), node, bound});
        std::push_heap(candidates_.begin(), candidates_.end());
        total_ += bound;
        peak_ = std::max(peak_, max_abs(total_));
    }

    Candidate take_largest() {
        std::pop_heap(candidates_.begin(), candidates_.end());
        const Candidate top = candidates_.back();
        candidates_.pop_back();
        total_ -= top.bound;
        return top;
    }

    /// Whether the sum is above the tolerance and something can be taken back. Nodes with lights inside the
    /// box have bounds many decades above what remains when they are gone, and rounding of that size: then
    /// the sum is made anew.
    bool exceeds(double tolerance) {
        if (candidates_.empty() || candidates_.front().key == 0.0) {
            total_ = glm::dvec3(0.0);
            return false;
        }
        const double total = max_abs(total_);
        if (!(total > 1e-6 * peak_) || total <= tolerance) {
            CompensatedSumRgb sum;
            for (const Candidate& candidate : candidates_) sum.add(candidate.bound);
            total_ = sum.total();
            peak_ = max_abs(total_);
        }
        return !(max_abs(total_) <= tolerance);
    }

    const std::vector<Candidate>& candidates() const { return candidates_; }
    const glm::dvec3& total() const { return total_; }

  private:
    std::vector<Candidate> candidates_;
    glm::dvec3 total_{0.0};
    double peak_ = 0;
};

}  // namespace

std::string_view to_text(DropReason reason) {
    switch (reason) {
        case DropReason::off:
            return "off";
        case DropReason::unreachable:
            return "unreachable";
        case DropReason::negligible:
            return "negligible";
    }
    return {};
}

CullingResult detail::LightTree::cull(const Box& box, double tolerance) const {
    validate(box);
    require_not_negative("tolerance", tolerance);
    Culled culled;
    const auto add = [&](std::int64_t index) { culled.add(index, bound(node(index), box)); };
    if (root_ >= 0) add(root_);
    for (std::size_t i = first_sun_; i < nodes_.size(); ++i) add(static_cast<std::int64_t>(i));

    CullingResult result;
    while (culled.exceeds(tolerance * (1 - 1e-12))) {
        const Node& largest = node(culled.take_largest().node);
        if (largest.left < 0) {
            result.kept.push_back(leaves_[largest.begin]->index);
        } else {
            add(largest.left);
            add(largest.right);
        }
    }
    std::sort(result.kept.begin(), result.kept.end());
    result.bound = culled.total();
    if (!off_.empty()) result.dropped.push_back({off_, DropReason::off, glm::dvec3(0.0)});
    for (const Candidate& candidate : culled.candidates()) {
        const DropReason reason = candidate.key > 0.0 ? DropReason::negligible : DropReason::unreachable;
        result.dropped.push_back({lights_of(node(candidate.node)), reason, candidate.bound});
    }
    return result;
}

}  // namespace skinglow
