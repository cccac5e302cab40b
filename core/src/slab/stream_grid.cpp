#include "slab/stream_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "numerics/quadrature.h"

namespace skinglow::detail {
namespace {

// Indices closer than this are one: the interval between them would hold grazing streams alone.
constexpr double same_index = 1e-10;
// A beam that grazes more than this is taken as this one: its invariant could not be told from the index.
constexpr double min_mu0 = 1e-6;

// Streams of each interval: in proportion to the angles it covers in the largest index, at least two.
// Rounding favors the shallow angles: a rule for the steep ones that is denser than that of the others costs
// accuracy.
std::vector<int> streams_by_interval(const std::vector<double>& index, int streams) {
    const double largest = index.back();
    std::vector<int> counts;
    double low = 0;
    int total = 0;
    for (const double high : index) {
        const double angle = std::asin(std::min(1.0, high / largest)) - std::asin(low / largest);
        counts.push_back(std::max(2, static_cast<int>(streams * angle * 2 / std::numbers::pi + 1e-9)));
        total += counts.back();
        low = high;
    }
    counts.back() = std::max(2, counts.back() + streams - total);
    return counts;
}

}  // namespace

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

StreamGrid::StreamGrid(std::span<const Layer> layers, Incidence incidence, double n_above, double n_below,
                       int streams)
    : n_above_(n_above), n_below_(n_below), requested_(streams) {
    check_arguments(layers, incidence, n_above, n_below, streams);
    double largest = 0;
    for (const Layer& layer : layers) largest = std::max(largest, layer.refractive_index);
    std::vector<double> index{std::min(n_above, largest), std::min(n_below, largest)};
    for (const Layer& layer : layers) index.push_back(layer.refractive_index);
    std::sort(index.begin(), index.end());
    index.erase(
        std::unique(index.begin(), index.end(), [](double a, double b) { return b - a <= same_index * b; }),
        index.end());
    index.back() = largest;

    const bool collimated = incidence.kind != Incidence::Kind::diffuse;
    const double mu0 = incidence.kind == Incidence::Kind::oblique ? std::max(incidence.mu0, min_mu0) : 1;
    const double invariant = n_above * std::sqrt((1 - mu0) * (1 + mu0));
    const std::vector<int> counts = streams_by_interval(index, streams);
    double low = 0;
    for (std::size_t i = 0; i < index.size(); ++i) {
        const bool here = collimated && invariant < index[i] && invariant >= low;
        // The beam's cosine in the interval's own index; formed from mu0 without a difference where they are
        // equal.
        const double ratio = n_above / index[i];
        const double cosine = std::sqrt((1 - ratio) * (1 + ratio) + ratio * ratio * mu0 * mu0);
        add_interval(low, index[i], counts[i], here, cosine);
        low = index[i];
    }

    root_flux_weight_.resize(size());
    for (int i = 0; i < size(); ++i) root_flux_weight_[i] = std::sqrt(flux_weight(i));
    incident_ = Eigen::VectorXd::Zero(count(n_above));
    if (collimated) {
        // The stream nearest to the beam is the beam's own.
        double nearest = 2;
        Eigen::Index own = -1;
        for (int i = 0; i < count(n_above); ++i) {
            const double distance = std::abs(cosine(i, n_above) - mu0);
            if (distance < nearest) {
                nearest = distance;
                own = i;
            }
        }
        if (invariant < largest * (1 - same_index) && own >= 0) {
            incident_[own] = 1 / root_flux_weight_[own];
        } else {
            reflected_outright_ = 1;
        }
    } else {
        incident_ = 2 / (n_above * n_above) * root_flux_weight_.head(incident_.size());
        reflected_outright_ = std::max(0.0, (n_above - largest) * (n_above + largest) / (n_above * n_above));
    }
    for (const Layer& layer : layers) {
        const double n = layer.refractive_index;
        if (bases_.contains(n)) continue;
        Eigen::VectorXd cosines(count(n));
        for (int i = 0; i < cosines.size(); ++i) cosines[i] = cosine(i, n);
        const Eigen::VectorXd weight =
            root_flux_weight_.head(cosines.size()).cwiseAbs2().cwiseQuotient(cosines) / (n * n);
        bases_.emplace(n, AngularBasis(cosines, weight));
    }
}

void StreamGrid::add_interval(double n_low, double n_high, int count, bool beam_here, double beam_cosine) {
    // Cosines in n_high, from the steepest at the lower index down to 0.
    const double ratio = n_low / n_high;
    const double steepest = std::sqrt((1 - ratio) * (1 + ratio));
    std::vector<Stream> added;
    const auto add = [&](const Quadrature& rule, double from, double to) {
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double cosine = from + (to - from) * rule.node[i];
            added.push_back({n_high, cosine, n_high * n_high * cosine * rule.weight[i] * (to - from)});
        }
    };
    constexpr double narrow = 1e-9;  // a piece beside the beam that is narrower needs no streams
    if (!beam_here) {
        add(gauss_rule(static_cast<std::size_t>(count)), 0, steepest);
    } else if (steepest - beam_cosine <= narrow) {
        add(gauss_rule(static_cast<std::size_t>(count), FixedNode::at_one), 0, steepest);
    } else {
        // A rule on either side that ends at the beam: both are smooth there, and the beam's stream is
        // shared.
        const int above =
            std::clamp(static_cast<int>(std::lround((count + 1) * (1 - beam_cosine / steepest))), 2,
                       std::max(2, count - 1));
        add(gauss_rule(static_cast<std::size_t>(std::max(2, count + 1 - above)), FixedNode::at_one), 0,
            beam_cosine);
        const Stream shared = added.back();
        added.pop_back();
        const std::size_t first = added.size();
        add(gauss_rule(static_cast<std::size_t>(above), FixedNode::at_zero), beam_cosine, steepest);
        added[first].cosine = beam_cosine;
        added[first].flux_weight += shared.flux_weight;
    }
    // Ascending n sin(theta) is descending cosine.
    streams_.insert(streams_.end(), added.rbegin(), added.rend());
}

int StreamGrid::count(double n) const {
    const auto propagates = [&](const Stream& stream) {
        return stream.interval_index <= n * (1 + same_index);
    };
    return static_cast<int>(std::partition_point(streams_.begin(), streams_.end(), propagates) -
                            streams_.begin());
}

double StreamGrid::cosine(int stream, double n) const {
    const Stream& s = streams_[static_cast<std::size_t>(stream)];
    const double ratio = s.interval_index / n;
    const double squared = (1 - ratio) * (1 + ratio) + ratio * ratio * s.cosine * s.cosine;
    return std::sqrt(std::max(squared, 1e-20));
}

// Born and Wolf, Principles of Optics, 1.5.2.
double StreamGrid::reflectance(int stream, double n_a, double n_b) const {
    if (stream >= count(std::min(n_a, n_b))) return 1;
    if (n_a == n_b) return 0;
    const double cosine_a = cosine(stream, n_a);
    const double cosine_b = cosine(stream, n_b);
    const double perpendicular = (n_a * cosine_a - n_b * cosine_b) / (n_a * cosine_a + n_b * cosine_b);
    const double parallel = (n_a * cosine_b - n_b * cosine_a) / (n_a * cosine_b + n_b * cosine_a);
    return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

}  // namespace skinglow::detail
