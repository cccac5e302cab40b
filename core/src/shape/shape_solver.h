#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "shape/part_solver.h"
#include "shape/thin_parts.h"

namespace skinglow::detail {

struct SolverOptions {
    double unit_mm = 1;
    double cell_mm = 0.8;
    double max_thickness_mm = 25;
    int threads = 0;
};

/// A thin part, made ready when light first falls on it.
class LazyPart {
  public:
    explicit LazyPart(ThinPart part) : part_(std::move(part)) {}
    const ThinPart& part() const { return part_; }
    /// The solver; made by the first call.
    template <typename Make>
    const PartSolver& solver(const Make& make) const {
        std::call_once(made_, [&] {
            auto made = make(part_);
            const std::lock_guard lock(access_);
            solver_ = std::move(made);
        });
        return *solver_;
    }
    /// The solver, or none where it was not made yet.
    const PartSolver* ready() const {
        const std::lock_guard lock(access_);
        return solver_.get();
    }

  private:
    ThinPart part_;
    mutable std::once_flag made_;
    mutable std::mutex access_;
    mutable std::unique_ptr<const PartSolver> solver_;
};

/// The flesh of a mesh of one medium: from irradiance at its vertices to exitance at its sites, node by node.
/// May be asked from many threads at once.
class ShapeSolver {
  public:
    /// @param points   places whose exitance is asked, units of the mesh; none: its vertices
    /// @param normals  one each; none: of the nearest triangle
    /// @param done     told the fraction done, in [0, 1]
    ShapeSolver(const MeshView& mesh, std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                const LaneMedium& medium, const SolverOptions& options,
                const std::function<void(double)>& done);
    ShapeSolver(const ShapeSolver&) = delete;
    ShapeSolver& operator=(const ShapeSolver&) = delete;

    /// Exitance of all sites. Where the flesh is thick it is that of a half-space under the same irradiance.
    /// @param light  one per vertex of the mesh given
    std::vector<Lanes> exitance(std::span<const Lanes> light, double tolerance) const;

    const Body& body() const { return body_; }
    const SurfaceSites& sites() const { return sites_; }
    const std::vector<float>& thickness() const { return thickness_; }
    const std::vector<std::unique_ptr<LazyPart>>& parts() const { return parts_; }
    const LaneMedium& medium() const { return medium_; }
    double margin() const { return margin_; }
    std::size_t bytes() const;

  private:
    const PartSolver& solver_of(const LazyPart& part) const;
    Lanes light_at(const Site& site, std::span<const Lanes> light) const;

    SolverOptions options_;
    Body body_;
    FleshSurface surface_;
    SurfaceSites sites_;
    LaneMedium medium_;
    double margin_;
    std::vector<float> thickness_;
    std::vector<std::unique_ptr<LazyPart>> parts_;
};

}  // namespace skinglow::detail
