#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "shape/part_solver.h"
#include "shape/thin_parts.h"

namespace skinglow::detail {

/// Something that is made when it is first asked for, by whoever asks first.
template <typename Value>
class Lazy {
  public:
    template <typename Make>
    const Value& get(const Make& make) const {
        // One makes it, the others wait; where it fails or is stopped, the next one tries.
        const std::lock_guard lock(making_);
        if (ready() == nullptr) {
            auto made = std::make_unique<const Value>(make());
            const std::lock_guard storing(access_);
            value_ = std::move(made);
        }
        return *value_;
    }
    /// None where it was not made yet.
    const Value* ready() const {
        const std::lock_guard lock(access_);
        return value_.get();
    }

  private:
    mutable std::mutex making_;
    mutable std::mutex access_;
    mutable std::unique_ptr<const Value> value_;
};

/// How often light may enter skin again.
constexpr int max_reentries = 8;

/// Rows for the vertices about a part whose sites are points: what light that enters skin again comes from.
struct VertexRows {
    std::vector<std::uint32_t> sites;  ///< of the vertices
    LastFlight flight;
    std::vector<std::uint32_t> lit_by;  ///< vertices whose irradiance the rows ask for, ascending
};

/// A thin part, made ready when light first falls on it.
struct LazyPart {
    ThinPart part;
    Lazy<PartSolver> solver;
    std::array<Lazy<VertexRows>, max_reentries> vertices;  ///< by step, as ShapeSolver::reentry

    std::size_t bytes() const {
        std::size_t sum = solver.ready() != nullptr ? solver.ready()->bytes() : 0;
        for (const Lazy<VertexRows>& step : vertices) {
            if (const VertexRows* rows = step.ready()) sum += rows->flight.bytes();
        }
        return sum;
    }
};

}  // namespace skinglow::detail
