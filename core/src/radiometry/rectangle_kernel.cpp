#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "numerics/vector_loops.h"
#include "radiometry/lamp_kernels.h"

namespace skinglow {
namespace {

constexpr double pi = std::numbers::pi;

/// Angle to the x axis of a point (x, y) with y >= 0, not both 0, of which t is the smaller of |x| and y over
/// the larger: as std::atan2, but without jumps. The polynomial for atan(t)/t in t^2 was fitted for this file
/// at Chebyshev points; its relative error on [0, 1] is below 1e-15.
[[gnu::always_inline]] inline double angle_of(double x, double y, double t) {
    const double s = t * t;
    double series = 3.050871193408966e-05;
    series = series * s - 0.00032154563814401627;
    series = series * s + 0.0016043955576606095;
    series = series * s - 0.005077035455033183;
    series = series * s + 0.011561031714663841;
    series = series * s - 0.020491576519416414;
    series = series * s + 0.03007007421146227;
    series = series * s - 0.03862602706431062;
    series = series * s + 0.04572065523173478;
    series = series * s - 0.05204629772924022;
    series = series * s + 0.058683836241904076;
    series = series * s - 0.06664141473585189;
    series = series * s + 0.07691971794257377;
    series = series * s - 0.09090877487115624;
    series = series * s + 0.11111109123872605;
    series = series * s - 0.14285714209119404;
    series = series * s + 0.19999999998434168;
    series = series * s - 0.3333333333332059;
    series = series * s + 0.9999999999999998;
    const double octant = t * series;
    const double quarter = y < std::abs(x) ? octant : 0.5 * pi - octant;
    return x < 0.0 ? pi - quarter : quarter;
}

/// The part of an edge above the horizon: places along it, and 1 where it goes below or comes up, else 0.
/// Written with numbers in place of conditions throughout: those would be jumps, and the loops would not be
/// vectorized.
struct EdgePart {
    double from, to;
    double goes_below, comes_up;
};

[[gnu::always_inline]] inline EdgePart part_above(double from, double to, double from_height,
                                                  double to_height) {
    const double drop = from_height - to_height;
    const double crossing = from_height / (drop == 0.0 ? 1.0 : drop);
    const double from_up = from_height < 0.0 ? 0.0 : 1.0;
    const double to_up = to_height < 0.0 ? 0.0 : 1.0;
    const double goes_below = from_up * (1.0 - to_up);
    const double comes_up = to_up * (1.0 - from_up);
    const double begin = comes_up > 0.0 ? crossing : 0.0;
    const double end = goes_below > 0.0 ? crossing : to_up;
    return {from + (to - from) * begin, from + (to - from) * end, goes_below, comes_up};
}

/// Lambert's term of a part of an edge whose line is at the root of `square` from the place: the angle it is
/// seen under, times the normal's component across it. One division serves both.
[[gnu::always_inline]] inline double edge_term(const EdgePart& part, double square, double across) {
    const double distance = std::sqrt(square);
    const double length = part.to - part.from;
    const double x = square + part.from * part.to;
    const double y = distance * (length < 0.0 ? -length : length);
    const double width = std::abs(x);
    const double larger = y < width ? width : y;
    const double inverse = 1.0 / (larger * distance);
    const double t = (y < width ? y : width) * distance * inverse;
    return across * larger * inverse * angle_of(x, y, t);
}

/// How many places of a block see something of the lamp, and how many see it cut by their horizon.
struct Sight {
    std::int64_t lit = 0;
    std::int64_t cut = 0;
};

SKINGLOW_VECTOR_CLONES
Sight rectangle_sight(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& p) {
    const glm::dvec3 l = light.position();
    const glm::dvec3 ax = light.frame()[0] * (area.half_x() * light.area_scale());
    const glm::dvec3 ay = light.frame()[1] * (area.half_y() * light.area_scale());
    const glm::dvec3 z = light.direction();
    const std::size_t count = p.count;
    Sight sight;
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = l.x - p.x[i];
        const double vy = l.y - p.y[i];
        const double vz = l.z - p.z[i];
        const double level = vx * p.nx[i] + vy * p.ny[i] + vz * p.nz[i];
        const double swing = std::abs(ax.x * p.nx[i] + ax.y * p.ny[i] + ax.z * p.nz[i]) +
                             std::abs(ay.x * p.nx[i] + ay.y * p.ny[i] + ay.z * p.nz[i]);
        // Rounding may not hide a cut: the loops below count corners in another way.
        const double margin = swing + 1e-12 * (std::abs(vx) + std::abs(vy) + std::abs(vz));
        double lit = vx * z.x + vy * z.y + vz * z.z <= 0.0 ? 1.0 : 0.0;
        lit = level < -margin ? 0.0 : lit;
        const double cut = level <= margin ? lit : 0.0;
        sight.lit += lit > 0.0 ? 1 : 0;
        sight.cut += cut > 0.0 ? 1 : 0;
    }
    return sight;
}

/// Lambert's formula in the lamp's frame, where each edge is parallel to an axis. What is below the horizon
/// is cut off; the cut is an edge of its own, between the places where the rim goes below and comes up.
[[gnu::always_inline]] inline void rectangle_loop(const PreparedLight& light, const AreaEmitter& area,
                                                  const PlaceBlock& p, BlockIrradiance& r, bool is_whole) {
    const glm::dvec3 l = light.position();
    const glm::dmat3 f = light.frame();
    const double scale = light.area_scale();
    const double a = area.half_x() * scale;
    const double b = area.half_y() * scale;
    const double per_power = 1.0 / (pi * 4.0 * a * b);
    const double far_square = 4e8 * scale * scale;  // beyond it the lamp is a point
    const double near_height = min_light_distance + 1e-9 * scale;
    const std::size_t count = p.count;
    const double* p_x = p.x.data();
    const double* p_y = p.y.data();
    const double* p_z = p.z.data();
    const double* p_nx = p.nx.data();
    const double* p_ny = p.ny.data();
    const double* p_nz = p.nz.data();
    double* value_out = r.value.data();
    double* special_out = r.special.data();
    SKINGLOW_VECTOR_LOOP
    for (std::size_t i = 0; i < count; ++i) {
        const double vx = p_x[i] - l.x;
        const double vy = p_y[i] - l.y;
        const double vz = p_z[i] - l.z;
        const double x = vx * f[0].x + vy * f[0].y + vz * f[0].z;
        const double y = vx * f[1].x + vy * f[1].y + vz * f[1].z;
        const double h = vx * f[2].x + vy * f[2].y + vz * f[2].z;
        const double nx = p_nx[i] * f[0].x + p_ny[i] * f[0].y + p_nz[i] * f[0].z;
        const double ny = p_nx[i] * f[1].x + p_ny[i] * f[1].y + p_nz[i] * f[1].z;
        const double nz = p_nx[i] * f[2].x + p_ny[i] * f[2].y + p_nz[i] * f[2].z;
        const double x0 = -a - x;
        const double x1 = a - x;
        const double y0 = -b - y;
        const double y1 = b - y;
        const double hh = h * h;
        const double corner00 = nx * x0 + ny * y0 - nz * h;
        const double corner10 = nx * x1 + ny * y0 - nz * h;
        const double corner11 = nx * x1 + ny * y1 - nz * h;
        const double corner01 = nx * x0 + ny * y1 - nz * h;
        const EdgePart low = is_whole ? EdgePart{x0, x1, 0.0, 0.0} : part_above(x0, x1, corner00, corner10);
        const EdgePart right = is_whole ? EdgePart{y0, y1, 0.0, 0.0} : part_above(y0, y1, corner10, corner11);
        const EdgePart high = is_whole ? EdgePart{x1, x0, 0.0, 0.0} : part_above(x1, x0, corner11, corner01);
        const EdgePart left = is_whole ? EdgePart{y1, y0, 0.0, 0.0} : part_above(y1, y0, corner01, corner00);
        double sum = edge_term(low, hh + y0 * y0, h * ny + y0 * nz);
        sum -= edge_term(high, hh + y1 * y1, h * ny + y1 * nz);
        sum -= edge_term(right, hh + x1 * x1, h * nx + x1 * nz);
        sum += edge_term(left, hh + x0 * x0, h * nx + x0 * nz);

        if (!is_whole) {
            const double out_x = low.goes_below * low.to + high.goes_below * high.to + right.goes_below * x1 +
                                 left.goes_below * x0;
            const double out_y = low.goes_below * y0 + high.goes_below * y1 + right.goes_below * right.to +
                                 left.goes_below * left.to;
            const double in_x = low.comes_up * low.from + high.comes_up * high.from + right.comes_up * x1 +
                                left.comes_up * x0;
            const double in_y = low.comes_up * y0 + high.comes_up * y1 + right.comes_up * right.from +
                                left.comes_up * left.from;
            const double is_cut = low.goes_below + high.goes_below + right.goes_below + left.goes_below;
            // Both places lie in the horizon's plane: their cross product is along the normal.
            const double across =
                -nx * h * (out_y - in_y) + ny * h * (out_x - in_x) + nz * (out_x * in_y - out_y * in_x);
            const double x_of_cut = out_x * in_x + out_y * in_y + hh;
            const double width = std::abs(x_of_cut);
            const double y_of_cut = across < 0.0 ? -across : across;
            const double t = (y_of_cut < width ? y_of_cut : width) / (y_of_cut < width ? width : y_of_cut);
            const double cut_angle = angle_of(x_of_cut, y_of_cut, t);
            const double cut = across < 0.0 ? cut_angle : -cut_angle;
            sum += is_cut > 0.0 ? cut : 0.0;
        }
        sum *= 0.5 * per_power;

        const double square = x * x + y * y + hh;
        // Without a cut a lamp is above the horizon with all of its corners, or with none.
        double lit = h >= 0.0 ? 1.0 : 0.0;
        lit = is_whole && corner00 < 0.0 ? 0.0 : lit;
        double special = h < near_height ? lit : 0.0;
        special = square > far_square ? lit : special;
        sum = sum > 0.0 ? sum : 0.0;
        value_out[i] = lit > 0.0 ? sum : 0.0;
        special_out[i] = special;
    }
}

SKINGLOW_VECTOR_CLONES
void cut_rectangle_block(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& p,
                         BlockIrradiance& r) {
    rectangle_loop(light, area, p, r, false);
}

SKINGLOW_VECTOR_CLONES
void whole_rectangle_block(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& p,
                           BlockIrradiance& r) {
    rectangle_loop(light, area, p, r, true);
}

}  // namespace

// Neighbors on a mesh mostly agree: all in the dark, or all with the whole lamp in sight.
void rectangle_block(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& p,
                     BlockIrradiance& r) {
    const Sight sight = rectangle_sight(light, area, p);
    if (sight.lit == 0) {
        r.value.fill(0.0);
        r.special.fill(0.0);
    } else if (sight.cut == 0) {
        whole_rectangle_block(light, area, p, r);
    } else {
        cut_rectangle_block(light, area, p, r);
    }
}

}  // namespace skinglow
