#include "skin/thickness_nodes.h"

#include <algorithm>
#include <cmath>

namespace skinglow {

ThicknessNodes::ThicknessNodes(std::span<const double> entries_mm, double kink_mm, double scale_mm,
                               std::size_t count)
    : entries_(entries_mm.begin(), entries_mm.end()) {
    const auto kink = std::lower_bound(entries_mm.begin(), entries_mm.end(), kink_mm);
    const auto below = static_cast<std::size_t>(kink - entries_mm.begin());
    add_stretch(entries_mm, 0, below, 0.0, std::min(kink_mm, entries_mm.back()), scale_mm, count);
    add_stretch(entries_mm, below, entries_mm.size(), kink_mm, entries_mm.back(), scale_mm, count);
}

void ThicknessNodes::add_stretch(std::span<const double> entries_mm, std::size_t first, std::size_t last,
                                 double start, double end, double scale_mm, std::size_t count) {
    if (first == last) return;
    Stretch stretch{nodes_.size(), count, first, last - first, std::nullopt, std::nullopt};
    if (stretch.entry_count <= count) {
        stretch.node_count = stretch.entry_count;
        for (std::size_t i = first; i < last; ++i) nodes_.push_back(entries_mm[i]);
        stretches_.push_back(std::move(stretch));
        return;
    }
    const auto top = static_cast<double>(count - 1);
    const double bend = std::log1p((end - start) / scale_mm);
    for (std::size_t i = 0; i < count; ++i) {
        nodes_.push_back(std::min(end, start + scale_mm * std::expm1(bend * static_cast<double>(i) / top)));
    }
    nodes_.back() = end;
    std::vector<double> places;
    for (std::size_t i = first; i < last; ++i) {
        places.push_back(std::clamp(top * std::log1p((entries_mm[i] - start) / scale_mm) / bend, 0.0, top));
    }
    std::vector<double> between;
    for (std::size_t i = 1; i < count; i += 2) between.push_back(0.5 * static_cast<double>(i));
    stretch.cubic.emplace(count, places);
    stretch.half.emplace((count + 1) / 2, between);
    stretches_.push_back(std::move(stretch));
}

bool ThicknessNodes::is_exact() const {
    return std::none_of(stretches_.begin(), stretches_.end(),
                        [](const Stretch& s) { return s.cubic.has_value(); });
}

void ThicknessNodes::to_entries(std::span<const double> at_nodes, std::span<double> at_entries) const {
    for (const Stretch& stretch : stretches_) {
        const auto nodes = at_nodes.subspan(stretch.first_node, stretch.node_count);
        const auto entries = at_entries.subspan(stretch.first_entry, stretch.entry_count);
        if (stretch.cubic) {
            stretch.cubic->evaluate(nodes, entries);
        } else {
            std::copy(nodes.begin(), nodes.end(), entries.begin());
        }
    }
}

void ThicknessNodes::predict_from_half(std::span<const double> at_nodes, std::span<double> predicted) const {
    std::copy(at_nodes.begin(), at_nodes.end(), predicted.begin());
    for (const Stretch& stretch : stretches_) {
        if (!stretch.half) continue;
        std::vector<double> even, between(stretch.half->places());
        for (std::size_t i = 0; i < stretch.node_count; i += 2)
            even.push_back(at_nodes[stretch.first_node + i]);
        stretch.half->evaluate(even, between);
        for (std::size_t i = 0; i < between.size(); ++i)
            predicted[stretch.first_node + 2 * i + 1] = between[i];
    }
}

}  // namespace skinglow
