#pragma once

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

/// Rows for the vertices about a part whose sites are points: what light that enters skin again comes from.
struct VertexRows {
    std::vector<std::uint32_t> sites;  ///< of the vertices
    LastFlight flight;
};

/// A thin part, made ready when light first falls on it.
struct LazyPart {
    ThinPart part;
    Lazy<PartSolver> solver;
    Lazy<VertexRows> vertices;

    std::size_t bytes() const {
        std::size_t sum = solver.ready() != nullptr ? solver.ready()->bytes() : 0;
        if (const VertexRows* rows = vertices.ready()) sum += rows->flight.bytes();
        return sum;
    }
};

}  // namespace skinglow::detail
