#include "shape/face_orientation.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace skinglow::detail {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// One side of a triangle, by its ends in ascending order.
struct Side {
    std::uint32_t low, high;
    std::uint32_t triangle;
    std::uint8_t corner;  ///< where it begins
    bool ascends;         ///< runs from the lower to the higher end
};

/// The neighbor over each side, and whether the two are wound against each other.
struct Neighbors {
    std::array<std::uint32_t, 3> triangle{none, none, none};
    std::array<bool, 3> opposed{};
};

std::vector<Neighbors> neighbors_of(std::span<const BodyTriangle> triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i].welded[k];
            const std::uint32_t b = triangles[i].welded[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), i, k, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    std::vector<Neighbors> result(triangles.size());
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
            ++end;
        if (end == i + 2) {  // an edge of three or more triangles binds none of them
            const Side& a = sides[i];
            const Side& b = sides[i + 1];
            result[a.triangle].triangle[a.corner] = b.triangle;
            result[b.triangle].triangle[b.corner] = a.triangle;
            result[a.triangle].opposed[a.corner] = result[b.triangle].opposed[b.corner] =
                a.ascends == b.ascends;
        }
        i = end;
    }
    return result;
}

}  // namespace

std::vector<bool> against_neighbors(std::span<const BodyTriangle> triangles) {
    const std::vector<Neighbors> neighbors = neighbors_of(triangles);
    std::vector<std::uint8_t> seen(triangles.size(), 0);
    std::vector<bool> against(triangles.size(), false);
    std::vector<std::uint32_t> piece;
    for (std::uint32_t first = 0; first < triangles.size(); ++first) {
        if (seen[first] != 0) continue;
        piece.assign(1, first);
        seen[first] = 1;
        double with_first = 0;
        double against_first = 0;
        for (std::size_t next = 0; next < piece.size(); ++next) {
            const std::uint32_t i = piece[next];
            (against[i] ? against_first : with_first) += static_cast<double>(triangles[i].area);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = neighbors[i].triangle[k];
                if (other == none || seen[other] != 0) continue;
                seen[other] = 1;
                against[other] = against[i] != neighbors[i].opposed[k];
                piece.push_back(other);
            }
        }
        if (against_first <= with_first) continue;
        for (const std::uint32_t i : piece) against[i] = !against[i];
    }
    return against;
}

}  // namespace skinglow::detail
