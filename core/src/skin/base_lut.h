#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

namespace skinglow {

/// Most entries a table may have: hosts hold it as an image one texel high, and none needs more.
constexpr std::size_t max_lut_size = 65536;

/// The thickness axis of a table: entry i stands at i / (size - 1) of the largest thickness, so that the
/// first is skin of no thickness and the last the thickest. A table of one entry stands at 0 and holds
/// everywhere.
class LutAxis {
  public:
    /// @param size 1 to max_lut_size; @param max_thickness_mm finite, above 0. Else std::invalid_argument.
    LutAxis(std::size_t size, double max_thickness_mm);

    std::size_t size() const { return size_; }
    double max_thickness_mm() const { return max_thickness_mm_; }
    /// Thickness of entry i, mm.
    double thickness_mm(std::size_t i) const;
    /// All of them, ascending, mm.
    std::vector<double> thickness_mm() const;

    /// Images hold entry i at the center of texel i. The image coordinate of a thickness is
    /// u = texel_scale * thickness + texel_offset; clamp u to the image and the table is clamped at both
    /// ends.
    double texel_scale() const;   ///< 1/mm
    double texel_offset() const;  ///< in [0, 1]

  private:
    std::size_t size_;
    double max_thickness_mm_;
};

/// What thin skin does to light, before any lamp is known: for each thickness d the 3x3 matrix M(d) that
/// turns linear Rec.709 light on the far side into linear Rec.709 light coming through (docs/method.md). The
/// paper's gray lookup image BLL is M(d) = BLL(d) * identity.
class BaseLut {
  public:
    /// From brightness. @param gray one value per entry, finite, 0 or more; 1 is full brightness, more is
    /// allowed.
    static BaseLut from_gray(std::span<const double> gray, double max_thickness_mm);

    /// @param matrices one per entry, finite (entries off the diagonal may be negative: linear Rec.709 is a
    /// small gamut). Throws std::invalid_argument, naming the entry, on a non-finite value, an empty or too
    /// long table.
    BaseLut(std::vector<glm::dmat3> matrices, double max_thickness_mm);

    const LutAxis& axis() const { return axis_; }
    std::size_t size() const { return matrices_.size(); }
    std::span<const glm::dmat3> matrices() const { return matrices_; }

  private:
    LutAxis axis_;
    std::vector<glm::dmat3> matrices_;
};

}  // namespace skinglow
