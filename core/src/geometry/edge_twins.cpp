#include "geometry/edge_twins.h"

#include <algorithm>

namespace skinglow::detail {
namespace {

/// An edge in the list of its lower vertex.
struct Edge {
    std::uint32_t high;
    std::uint32_t corner;
    bool operator<(const Edge& other) const {
        return high != other.high ? high < other.high : corner < other.corner;
    }
};

}  // namespace

std::vector<std::uint32_t> edge_twins(std::span<const std::uint32_t> corners,
                                      std::span<const std::uint32_t> begin, std::size_t vertices) {
    const auto for_each_edge = [&](const auto& use) {
        for (std::size_t face = 0; face + 1 < begin.size(); ++face) {
            for (std::uint32_t c = begin[face]; c < begin[face + 1]; ++c) {
                const std::uint32_t a = corners[c];
                const std::uint32_t b = corners[c + 1 < begin[face + 1] ? c + 1 : begin[face]];
                use(std::min(a, b), Edge{std::max(a, b), c});
            }
        }
    };
    // By counting: the edges of each lower vertex are few.
    std::vector<std::uint32_t> first(vertices + 1, 0);
    for_each_edge([&](std::uint32_t low, const Edge&) { ++first[low + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<Edge> edges(corners.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for_each_edge([&](std::uint32_t low, const Edge& edge) { edges[next[low]++] = edge; });
    std::vector<std::uint32_t> twins(corners.size(), no_twin);
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto end = edges.begin() + first[v + 1];
        std::sort(edges.begin() + first[v], end);
        for (auto edge = edges.begin() + first[v]; edge != end;) {
            const auto last = std::find_if(edge, end, [&](const Edge& e) { return e.high != edge->high; });
            if (last - edge == 2) {
                twins[edge->corner] = edge[1].corner;
                twins[edge[1].corner] = edge->corner;
            }
            edge = last;
        }
    }
    return twins;
}

}  // namespace skinglow::detail
